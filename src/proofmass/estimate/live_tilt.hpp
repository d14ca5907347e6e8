#pragma once

#include <memory>
#include <optional>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/tilt.hpp"

// Roll and pitch on a moving base: tilt.hpp's filter online.
namespace proofmass::estimate {

struct LiveTiltOptions {
  Triad accelerometer{};             ///< m/s², all three axes
  std::optional<Triad> gyroscope{};  ///< rad/s, all three, in the same axes
  /// Options as for estimate_tilt(); `base`, `noise`, `shortest_rest_s` and `progress` are not
  /// used.
  TiltOptions tilt{};
  double rate_hz = 0.0;         ///< sample rate; 0: from the time stamps
  double start_s = 1.0;         ///< duration used to estimate the measurement noise
  double lag_s = 0.25;          ///< lag of the smoother
  double most_rate_hz = 200.0;  ///< faster samples are averaged down to this
};

/// Roll and pitch of a base that may move at any time, online. Columns:
///
///   roll, roll_std, pitch, pitch_std (rad)   at the row's time, given all samples so far; NaN
///                                            where an angle is not defined
///   smoothed_time (s), smoothed_roll, …      `lag_s` earlier, given the same samples; NaN in the
///                                            first `lag_s`
///   nis                                      squared innovations over their variance, mean over
///                                            the axes: 1 if the filter's model is correct
///
/// The filter is estimate_tilt()'s for a moving base, without knowledge of later rests:
///
/// - The strength of the base's acceleration is estimated from the scatter of the force over the
///   last 6 or 30 s, whichever is larger; its time constant from the correlation time of that
///   scatter. Before that 1 m/s² is assumed.
/// - At rest 2 mg of acceleration are still assumed, so the bands are conservative there.
/// - Without gyroscope, the strength of the base's rotation is estimated with two parallel filters
///   that assume √10 times more and less. If one has predicted the last five seconds better, all
///   three are shifted. Horizontal acceleration of the base is then not distinguishable from tilt.
///
/// Cost: some 10 µs a sample, without gyroscope three times that; no allocation per sample once
/// started. Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_tilt(const LiveTiltOptions& options);

}  // namespace proofmass::estimate
