#pragma once

#include <memory>
#include <optional>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/tilt.hpp"

// Roll and pitch while the base moves: tilt.hpp's filter on samples as they come.
namespace proofmass::estimate {

struct LiveTiltOptions {
  Triad accelerometer{};             ///< m/s², all three axes
  std::optional<Triad> gyroscope{};  ///< rad/s, all three, in the same axes
  /// As of estimate_tilt(); `base`, `noise`, `shortest_rest_s` and `progress` are not read.
  TiltOptions tilt{};
  double rate_hz = 0.0;         ///< of the samples; 0: told by their stamps
  double start_s = 1.0;         ///< by which the readings' noise is told
  double lag_s = 0.25;          ///< how far back the smoother looks
  double most_rate_hz = 200.0;  ///< faster samples are averaged down to this
};

/// Roll and pitch of a base that may move at any time, as its samples come. Its columns:
///
///   roll, roll_std, pitch, pitch_std (rad)   at the row's time, given all samples so far; NaN
///                                            where an angle is not defined
///   smoothed_time (s), smoothed_roll, …      the instant `lag_s` before, given the same samples;
///                                            NaN in the first `lag_s`
///   nis                                      squared innovations over their variance, mean over
///                                            the axes: 1 where the filter's model is true
///
/// The filter is estimate_tilt()'s of a moving base, without its knowledge of later rests: the
/// base's acceleration is read off the scatter of the force over the last 6 or 30 s, whichever
/// shows more, and its time constant off how long the scatter hangs together; before that 1 m/s² is
/// taken to be possible. At rest 2 mg of acceleration are left possible, so that the bands are
/// cautious there. Without gyroscope how strong the base turns is told by two filters beside that
/// take it for √10 times more and less: where one has predicted the last five seconds better, all
/// three move. A base that speeds up on the level cannot then be told from one that tilts.
///
/// Cost: some 10 µs a sample, without gyroscope three times that; nothing is allocated for one once
/// started. Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_tilt(const LiveTiltOptions& options);

}  // namespace proofmass::estimate
