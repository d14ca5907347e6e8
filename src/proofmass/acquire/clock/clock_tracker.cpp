#include "proofmass/acquire/clock/clock_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::acquire {

void ClockTracker::restart(double time_s, double step_s) {
  *this = {};
  time_s_ = time_s;
  step_s_ = step_s;
}

double ClockTracker::follow(double rows, double time_s) {
  constexpr unsigned longest_memory = 50;
  count_ = std::min(count_ + 1, longest_memory);
  const double k = static_cast<double>(count_) + 1.0;
  const double level_gain = 2.0 * (2.0 * k - 1.0) / (k * (k + 1.0));
  const double slope_gain = 6.0 / (k * (k + 1.0));
  const double before_s = time_s_;
  const double predicted_s = time_s_ + step_s_ * rows;
  const double missed_s = time_s - predicted_s;
  const double fading = 1.0 / k;
  squares_ += fading * (missed_s * missed_s - squares_);
  interval_ += fading * (time_s - before_s - interval_);
  step_s_ = std::max(0.0, step_s_ + slope_gain * missed_s / rows);
  time_s_ = predicted_s + level_gain * missed_s;
  constexpr double too_scattered = 0.75;
  if (std::sqrt(squares_) < too_scattered * interval_) return time_s_;
  return time_s;
}

}  // namespace proofmass::acquire
