#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/quantity.hpp"

namespace proofmass::acquire {

/// How the host's clock runs against another, told from when things arrived: delays are positive
/// only and come in bursts, so that of each second the earliest arrival counts. A line through
/// these by least squares; its uncertainty is from the scatter about it, with what neighbours have
/// in common. See docs/methods/record.md.
/// Memory: 4096 points at most; from there on stretches are twice as long.
class ClockFit {
 public:
  /// Something that was at `own_s` by its own clock arrived at `host_s` by the host's.
  void add(double own_s, double host_s);

  /// Host's seconds for one of its own, less 1; nullopt before half a minute.
  [[nodiscard]] std::optional<Uncertain> rate_error() const;

 private:
  struct Point {
    double own_s;
    double ahead_s;  ///< host's time less its own
  };
  void halve();

  std::vector<Point> points_;
  double stretch_s_ = 1.0;
  double next_s_ = 0.0;  ///< where the next stretch begins
};

}  // namespace proofmass::acquire
