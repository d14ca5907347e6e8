#pragma once

#include <array>
#include <memory>
#include <optional>

#include "proofmass/core/live_analysis.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track.hpp"

// Displacement from rest to rest while the samples come: track.hpp's inertial model on live data.
namespace proofmass::estimate {

struct LiveTrackOptions {
  /// One to three axes, m/s², gravity in them or not.
  Triad sensor{};
  /// Direction of the displacement in the sensor's axes, any length. Absent: that in which the
  /// first motion is fastest; its rows come when it ends.
  std::optional<std::array<double, 3>> axis = std::nullopt;
  AccelFigures figures{};            ///< of a sensor file; the warm-up is not read
  double rest_speed_std_mps = 1e-4;  ///< of a sensor that lies still
  double scale_std = 0.01;           ///< relative, of the readings
  double rate_hz = 0.0;              ///< of the samples; 0: told by their stamps
  double lag_s = 3.0;           ///< how far back the smoother looks; a stop is seen after 1.2 s
  double most_rate_hz = 200.0;  ///< faster samples are averaged down to this
};

/// Position along the axis, counted from the first rest. Its columns:
///
///   position, position_std (m)    at the row's time, given all samples that are settled by then
///   velocity, velocity_std (m/s)
///   smoothed_time (s)             the instant `lag_s` before, and the position then given the same
///   smoothed_position, …_std (m)  samples; NaN until `lag_s` of filtering have passed
///   resting                       1 where the sensor is known to lie still, else 0
///
/// Between stops the acceleration less the bias is the input; at a stop the velocity is 0 and the
/// readings, gravity's share in them, are the bias. What errs in motion (InertialAxis' J, L and q)
/// has one common scale with a wide prior that the velocities left over at stops narrow. Intervals
/// of 95 % are 1.96 standard deviations: the mixture's tails are in them.
///
/// Rows come late: an instant is filtered when it is known whether the sensor rests, in motion with
/// the block it lies in (1/16 s, or 4 samples), at rest two blocks later or more. A stop is known
/// 1.2 s after the motion, for slow noise takes that long to be told from motion; the estimate is
/// pulled in there, and the smoothed one before it.
///
/// Bands are rather too wide than too narrow: with few stops, and by jumps and walks that leave
/// less open than white noise. Motion so slow that its accelerations lie within the noise is no
/// motion to the search for rests, and not seen here either. Constant speed is told from a stop by
/// what speed is left over, for ten seconds.
///
/// It begins with a rest: three seconds without motion before the first, by which the noise is
/// known. The sensor must not turn: where the level of two rests differs, a note says by how much
/// and all positions from there on are as much less sure as that may have done.
///
/// Memory: a minute of samples at most, and `lag_s` of states. Nothing is allocated for a sample
/// once running; the search for rests allocates once a block.
/// Errors: invalid_argument.
[[nodiscard]] Result<std::unique_ptr<LiveAnalysis>> live_track(const LiveTrackOptions& options);

}  // namespace proofmass::estimate
