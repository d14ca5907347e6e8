#pragma once

#include <array>
#include <memory>
#include <optional>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track.hpp"

// Displacement from rest to rest online: track.hpp's inertial model on live data.
namespace proofmass::estimate {

struct LiveTrackOptions {
  /// One to three axes, m/s², with or without gravity.
  Triad sensor{};
  /// Direction of the displacement in the sensor's axes, any length. Absent: the direction of the
  /// highest speed in the first motion; its rows are output when it ends.
  std::optional<std::array<double, 3>> axis = std::nullopt;
  AccelFigures figures{};            ///< from a sensor file; the warm-up is not used
  double rest_speed_std_mps = 1e-4;  ///< velocity of a sensor at rest
  double scale_std = 0.01;           ///< relative scale uncertainty
  double rate_hz = 0.0;              ///< sample rate; 0: from the time stamps
  double lag_s = 3.0;                ///< lag of the smoother; a stop is detected after 1.2 s
  double most_rate_hz = 200.0;       ///< faster samples are averaged down to this
};

/// Position along the axis, relative to the first rest. Columns:
///
///   position, position_std (m)    at the row's time, given all samples settled by then
///   velocity, velocity_std (m/s)
///   smoothed_time (s)             `lag_s` earlier, and the position then given the same samples;
///   smoothed_position, …_std (m)  NaN until `lag_s` of filtering have passed
///   resting                       1 if the sensor is known to be at rest, else 0
///
/// Model:
///
/// - Between stops the acceleration minus the bias is the input; at a stop the velocity is 0 and
///   the measurement, including the component of gravity, is the bias.
/// - The errors in motion (InertialAxis' J, L and q) share one scale with a wide prior, which the
///   closure velocities at the stops narrow. 95 % intervals are 1.96 standard deviations; these
///   include the mixture's tails.
/// - Output is delayed until the static or moving state of a sample is known: in motion until the
///   end of its block (1/16 s, or 4 samples), at rest by two blocks or more. A stop is detected 1.2
///   s after the motion, the time needed to distinguish slow noise from motion; the estimate is
///   corrected there, and the smoothed one before it.
///
/// Limits:
///
/// - Bands are conservative: with few stops, and because jumps and random walks leave less
///   uncertainty than white noise.
/// - Motion whose accelerations are within the noise is not detected. Constant speed is
///   distinguished from a stop by the remaining speed, for ten seconds.
/// - The recording must begin with a rest: three seconds without motion, which determine the noise.
/// - The sensor must not rotate: if the levels of two rests differ, a note reports the difference,
///   and the uncertainty of all later positions includes its possible effect.
///
/// Memory: a minute of samples at most, and `lag_s` of states. No allocation per sample once
/// running; the rest detector allocates once a block. Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_track(const LiveTrackOptions& options);

}  // namespace proofmass::estimate
