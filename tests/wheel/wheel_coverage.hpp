#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "wheel_world.hpp"

// Coverage of the intervals of estimate_wheel().
namespace proofmass::wheel_world {

/// Errors of one parameter in units of its stated standard deviation, over many recordings.
struct Tally {
  std::vector<double> z;
  std::size_t none = 0;  ///< no value given

  void add(const std::optional<Uncertain>& told, double truth);
  void append(const Tally& other);
  [[nodiscard]] std::size_t given() const { return z.size(); }
  [[nodiscard]] double coverage_95() const;
  [[nodiscard]] double largest() const;
  [[nodiscard]] double rms() const;
};

struct Coverage {
  Tally turns, angle, radius, bias, scale, skew, encoder, gyro, rolling;
  std::size_t recordings = 0, refused = 0;
};

/// Recordings `first` … `first + count − 1` of a scenario, on all processors.
[[nodiscard]] Coverage coverage_of(const Scenario& scenario,
                                   std::uint64_t first,
                                   int count,
                                   bool verbose = false);

}  // namespace proofmass::wheel_world
