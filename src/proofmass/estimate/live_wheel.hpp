#pragma once

#include <memory>
#include <vector>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel.hpp"

// Wheel angle online: wheel.hpp's filter on samples as they arrive.
namespace proofmass::estimate {

struct LiveWheelOptions {
  /// One or two accelerometers on the wheel, m/s²; without z its x and y lie in the wheel's plane.
  std::vector<Triad> sensors{};
  /// Gyroscope of each sensor in the same axes, rad/s, without channels where it has none; or
  /// empty.
  std::vector<Triad> gyroscopes{};
  /// Gravity, spin axis, radii and alignment as for estimate_wheel(); `clocks_shared` is assumed
  /// true, `rim_radius_m` and `progress` are not used.
  WheelOptions wheel{};
  double rate_hz = 0.0;         ///< sample rate; 0: from the time stamps
  double start_s = 4.0;         ///< duration collected before initialisation
  double lag_s = 0.25;          ///< lag of the smoother
  double most_rate_hz = 500.0;  ///< faster samples are averaged down to this
};

/// Angle and speed of a wheel online. Columns:
///
///   angle, angle_std (rad)    at the row's time given all samples so far, counting turns from the
///                             first row
///   speed, speed_std (rad/s)
///   smoothed_time (s)         `lag_s` earlier, and angle and speed then given the same samples;
///   smoothed_angle, …         NaN in the first `lag_s`
///   nis                       squared innovations over their variance, mean over the channels: 1
///                             if the filter's model is correct; NaN without measurements
///
/// Initialisation:
///
/// - `start_s` of samples are collected. A background thread estimates the wheel's plane, phase,
///   noise, lever arms and constants from them as estimate_wheel() does; a second later all samples
///   so far are filtered again from the first.
/// - If they cover less than a turn, this is repeated after a full turn; if they do not determine
///   the lever arms, after a change of speed.
///
/// Operation:
///
/// - Each epoch is filtered with the lever arms held constant. Parallel filters with other lever
///   arms give the effect of their uncertainty on the angle.
/// - Two more parallel filters use other noise parameters. Each second the likelihood decides
///   whether the motion noise is raised, lowered or kept, and the innovations determine the
///   measurement noise.
/// - Measurements of unexpected motion raise the motion noise at once. If that does not help, or
///   samples are missing until the angle is lost, the filter is reinitialised; turns may then be
///   lost, and a note reports it.
///
/// Cost: see docs/methods/live.md; no allocation per sample once started. Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_wheel(const LiveWheelOptions& options);

}  // namespace proofmass::estimate
