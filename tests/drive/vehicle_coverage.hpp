#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "vehicle_world.hpp"

// Coverage of the 95 % intervals of estimate_drive().
namespace proofmass::drive_world {

/// Errors of one quantity, in standard deviations.
struct Coverage {
  std::size_t recordings = 0, inside = 0, absent = 0;
  double sum = 0.0, sum2 = 0.0, largest = 0.0;
  double rms_error = 0.0;  ///< sum of squares of the errors themselves while counting

  void add(const std::optional<Uncertain>& estimate, double truth);
  [[nodiscard]] double percent() const;
};

/// By quantity: distance, heading, end, circumference, track, clock.
using Table = std::map<std::string, Coverage>;

/// Runs a scenario with seeds first, first + 1, …; `refused` counts recordings without a solution.
struct Covered {
  Table table;
  std::size_t refused = 0;
};
[[nodiscard]] Covered cover(const Scenario& scenario, std::uint64_t first, std::size_t count);

}  // namespace proofmass::drive_world
