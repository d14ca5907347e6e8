#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/drive.hpp"

// From one sensor to what the vehicle's filter uses of it. Private to the module.
namespace proofmass::estimate::drive {

/// Angle of a wheel and the yaw angle that its gyroscope saw, on the recording's own clock.
struct Trace {
  std::vector<double> time_s;
  std::vector<double> angle_rad, angle_std_rad, speed_radps;  ///< empty for a frame
  /// Integrated yaw rate, a left turn positive; empty without a gyroscope. A steered wheel's
  /// includes its steering.
  std::vector<double> yaw_rad;
  /// Variance up to each time by rates that are missing in motion, and interpolated; empty: none.
  std::vector<double> yaw_gap_rad2;
  double yaw_walk_rad2ps = 0.0;     ///< variance that the noise of the yaw rate adds in a second
  double yaw_bias_std_radps = 0.0;  ///< constant part of its error, while the vehicle moves
  double spin_tilt_rad = 0.0;       ///< of the gyroscope's spin axis against the sensor's nearest
  std::optional<Uncertain> turns;
  std::optional<Uncertain> rolling_radius_m;  ///< as the wheel's own sensors show it
  std::vector<Note> notes;
};

/// Angle by estimate_wheel(), or the encoder's; forward positive is chosen later. Errors: those of
/// estimate_wheel, not_observable (the count of turns is ambiguous).
[[nodiscard]] Result<Trace> trace_wheel(const DriveWheel& wheel, const WheelOptions& options);

inline constexpr double standing_radps = 0.05;  ///< slower, a wheel is taken to stand

/// Intervals of at least `least_s` in which a wheel turns slower than standing_radps.
[[nodiscard]] std::vector<Stretch> rests_of(const Trace& wheel, double least_s);

/// The wheel turned over: angle and speed change sign, the yaw does not.
void reverse(Trace& wheel);

/// Linear interpolation at time t of values at ascending times; the first or last outside.
[[nodiscard]] double at_time(const std::vector<double>& time_s,
                             const std::vector<double>& values,
                             double t);

}  // namespace proofmass::estimate::drive
