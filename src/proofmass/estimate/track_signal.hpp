#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track_epochs.hpp"
#include "proofmass/estimate/track_stops.hpp"

// What the measurements are and where they stand, before anything is integrated. Private to the
// module's track*.cpp.
namespace proofmass::estimate {

/// The axes that there are, less the level of the first rest; NaN where any of them has no
/// measurement.
struct TrackSignal {
  std::vector<double> time_s;
  std::vector<std::vector<double>> accel_mps2;
  std::vector<std::size_t> axes;       ///< 0 x, 1 y, 2 z: which of the sensor's each is
  std::vector<double> reference_mps2;  ///< taken off each
  double rate_hz = 0.0;                ///< 1 / median step
  std::size_t missing = 0;             ///< samples without a measurement
  Stops stops;
  GravityContent gravity = GravityContent::unknown;
  std::optional<double> resting_norm_mps2;  ///< median length of the level at rest, of three axes
};

/// Errors: invalid_argument (lengths that differ, time that does not ascend, no axis; measurements
/// in another unit than is said), too_few_samples.
[[nodiscard]] Result<TrackSignal> track_signal(const TrackSensor& sensor,
                                               const TrackOptions& options);

/// The mean reading of a rest, its reference put back.
struct RestLevel {
  std::array<double, 3> level_mps2{};
  double length_mps2 = 0.0, std_mps2 = 0.0;  ///< of the level, and of that by the noise of rest
  double duration_s = 0.0;
  [[nodiscard]] double cosine_to(const RestLevel& other) const;
};
/// Of each rest, of three axes.
[[nodiscard]] std::vector<RestLevel> rest_levels(const TrackSignal& signal);

/// Noise of each rest, from the differences of its measurements over all axes, m/s².
[[nodiscard]] std::vector<double> rest_noises(const TrackSignal& signal);

/// The rests that are at most twice as loud as the quietest: a sensor that is carried at constant
/// speed reads as at rest, but it shakes.
[[nodiscard]] std::vector<signal::Rest> quiet_rests(const TrackSignal& signal);

/// Whether nearly everything was taken for rest though its measurements integrate to a velocity far
/// beyond what their noise does: a slow motion looks like that, and so does drift.
[[nodiscard]] bool may_hide_motion(const TrackSignal& signal);

/// Turning of the level from rest to rest: how far the sensor was tilted meanwhile, if gravity is
/// in the measurements of three axes.
[[nodiscard]] std::optional<double> largest_turn_rad(const TrackSignal& signal);

/// Whether the measurements behave like the rate of change of an acceleration. What such
/// measurements integrate to twice is a velocity: it is 0 at every true rest, and where it stays
/// away from 0 with no measurement to speak of, the sensor shakes, for it is under way.
struct JerkSuspicion {
  bool suspected = false;
  double cruising_s = 0.0;  ///< time without acceleration yet louder than at rest, away from 0
  double pushing_s = 0.0;   ///< the rest of the motion
};
[[nodiscard]] JerkSuspicion suspect_jerk(const TrackSignal& signal, const TrackSeries& series);

}  // namespace proofmass::estimate
