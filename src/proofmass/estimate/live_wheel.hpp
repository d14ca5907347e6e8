#pragma once

#include <memory>
#include <vector>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/wheel.hpp"

// The angle of a wheel while it turns: wheel.hpp's filter on samples as they come.
namespace proofmass::estimate {

struct LiveWheelOptions {
  /// One or two accelerometers on the wheel, m/s²; without z its x and y lie in the wheel's plane.
  std::vector<Triad> sensors{};
  /// Gravity, spin axis, radii and alignment as of estimate_wheel(); `clocks_shared` is taken for
  /// true, `rim_radius_m` and `progress` are not read.
  WheelOptions wheel{};
  double rate_hz = 0.0;         ///< of the samples; 0: told by their stamps
  double start_s = 4.0;         ///< what is gathered before the wheel is looked for
  double lag_s = 0.25;          ///< how far back the smoother looks
  double most_rate_hz = 500.0;  ///< faster samples are averaged down to this
};

/// Angle and speed of a wheel as its samples come. Its columns:
///
///   angle, angle_std (rad)    of the wheel at the row's time given all samples so far, counting
///                             turns from the first row on
///   speed, speed_std (rad/s)
///   smoothed_time (s)         the instant `lag_s` before, and angle and speed then given the same
///   smoothed_angle, …         samples; NaN in the first `lag_s`
///   nis                       squared innovations over their variance, mean over the channels: 1
///                             where the filter's model is true; NaN where nothing was read
///
/// The start: `start_s` of samples are gathered, the wheel's plane, phase, noise, places and
/// constants are found from them as estimate_wheel() does, on a thread beside, and a second later
/// all so far are filtered once more from the first on. Where they show less than a turn, this is
/// done again after a whole one; where they do not show the sensors' places, after the speed has
/// changed. From then on each instant is filtered as it comes, with the places held: what their
/// uncertainty does to the angle is told by filters beside it that hold other places. Two further
/// filters hold other noise: each second the likelihood says whether the motion's noise rises,
/// falls or stays, and the innovations what the readings' is. Where readings tell of a motion that
/// nobody expected the noise rises at once, and where that does not help, or samples are missing
/// until the angle is anybody's guess, the wheel is looked for anew; turns may then be lost, and a
/// note says so.
///
/// Cost: see docs/methods/live.md; nothing is allocated for a sample once started.
/// Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_wheel(const LiveWheelOptions& options);

}  // namespace proofmass::estimate
