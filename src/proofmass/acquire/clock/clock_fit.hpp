#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/quantity.hpp"

namespace proofmass::acquire {

/// Rate of the host's clock relative to another, estimated from arrival times. Delays are positive
/// and bursty, so only the earliest arrival of each second is used. A least-squares line through
/// these; its uncertainty is from the scatter about the line, including autocorrelation. See
/// docs/methods/record.md.
/// Memory: at most 4096 points; beyond that the intervals are doubled.
class ClockFit {
 public:
  /// A sample with the time `own_s` on its own clock arrived at `host_s` on the host's.
  void add(double own_s, double host_s);

  /// Host's seconds per second of the other clock, minus 1; nullopt before half a minute.
  [[nodiscard]] std::optional<Uncertain> rate_error() const;

 private:
  struct Point {
    double own_s;
    double ahead_s;  ///< host's time minus the other clock's
  };
  void halve();

  std::vector<Point> points_;
  double stretch_s_ = 1.0;
  double next_s_ = 0.0;  ///< start of the next interval
};

}  // namespace proofmass::acquire
