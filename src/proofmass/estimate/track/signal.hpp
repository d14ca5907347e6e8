#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/track.hpp"
#include "proofmass/estimate/track/epochs.hpp"
#include "proofmass/estimate/track/stops.hpp"

// Checks and preparation of the measurements before integration.
namespace proofmass::estimate {

/// The axes present, minus the level of the first rest; NaN where any of them has no measurement.
struct TrackSignal {
  std::vector<double> time_s;
  std::vector<std::vector<double>> accel_mps2;
  std::vector<std::size_t> axes;       ///< 0 x, 1 y, 2 z: the sensor's axis of each
  std::vector<double> reference_mps2;  ///< subtracted from each
  double rate_hz = 0.0;                ///< 1 / median step
  std::size_t missing = 0;             ///< samples without a measurement
  Stops stops;
  GravityContent gravity = GravityContent::unknown;
  std::optional<double> resting_norm_mps2;  ///< median length of the level at rest, of three axes
};

/// Errors: invalid_argument (unequal lengths, non-ascending time, no axis; measurements in another
/// unit than stated), too_few_samples.
[[nodiscard]] Result<TrackSignal> track_signal(const TrackSensor& sensor,
                                               const TrackOptions& options);

/// The mean measurement of a rest, with its reference added back.
struct RestLevel {
  std::array<double, 3> level_mps2{};
  double length_mps2 = 0.0, std_mps2 = 0.0;  ///< of the level, and of that by the noise of rest
  double duration_s = 0.0;
  [[nodiscard]] double cosine_to(const RestLevel& other) const;
};
/// Level of each rest, with three axes.
[[nodiscard]] std::vector<RestLevel> rest_levels(const TrackSignal& signal);

/// Noise of each rest, from the differences of its measurements over all axes, m/s².
[[nodiscard]] std::vector<double> rest_noises(const TrackSignal& signal);

/// The rests at most twice as loud as the quietest: at constant speed a sensor measures the same as
/// at rest, but vibrates.
[[nodiscard]] std::vector<signal::Rest> quiet_rests(const TrackSignal& signal);

/// Whether nearly everything was classified as rest although the integrated velocity far exceeds
/// its noise: due to slow motion, or to drift.
[[nodiscard]] bool may_hide_motion(const TrackSignal& signal);

/// Rotation of the level between rests: the sensor's tilt meanwhile, if gravity is in the
/// measurements of three axes.
[[nodiscard]] std::optional<double> largest_turn_rad(const TrackSignal& signal);

/// Whether the measurements behave like the derivative of an acceleration. Their double integral is
/// then a velocity: it is 0 at every true rest, and if it differs from 0 while the measurements are
/// near 0, the sensor vibrates because it is in motion.
struct JerkSuspicion {
  bool suspected = false;
  double cruising_s = 0.0;  ///< time without acceleration yet louder than at rest, away from 0
  double pushing_s = 0.0;   ///< the rest of the motion
};
[[nodiscard]] JerkSuspicion suspect_jerk(const TrackSignal& signal, const TrackSeries& series);

}  // namespace proofmass::estimate
