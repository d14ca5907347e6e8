#pragma once

#include <cstdint>

namespace proofmass::acquire {

/// Recursive line fit of host time against row number: removes delivery jitter and follows slow
/// changes of the rate. It starts as the least-squares line through all points and becomes a
/// fading-memory fit over about fifty arrivals.
/// Source: Brookner, Tracking and Kalman Filtering Made Easy (1998), 1.2.10 (growing memory and
/// fading gains of the g-h filter).
class ClockTracker {
 public:
  void restart(double time_s, double step_s);
  /// An arrival at `time_s`, `rows` rows later; returns the time on the line. Times that scatter as
  /// much as their intervals are returned unchanged.
  [[nodiscard]] double follow(double rows, double time_s);
  [[nodiscard]] double step_s() const { return step_s_; }

 private:
  double time_s_ = 0.0;
  double step_s_ = 0.0;
  double squares_ = 0.0;   ///< mean square residual, fading memory
  double interval_ = 0.0;  ///< between arrivals, fading memory
  unsigned count_ = 0;
};

}  // namespace proofmass::acquire
