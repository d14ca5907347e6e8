#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/consistency.hpp"
#include "proofmass/signal/rests.hpp"

// Displacement of a carried accelerometer, from rest to rest.
namespace proofmass::estimate {

/// Further data of an accelerometer from its sensor file, per axis.
struct AccelFigures {
  /// Absent: white noise from the rests, no random walk.
  std::array<std::optional<double>, 3> white_mps2_rthz{}, walk_mps2_rts{};
  /// Time constant of the warm-up, whose known course is removed; absent: random-walk bias.
  std::array<std::optional<double>, 3> warm_up_time_s{};
};

/// Maximum number of parallel accelerometers for `fused`, including the first.
inline constexpr std::size_t most_fused_sensors = 4;

/// A further accelerometer on the same body, with axes parallel to the first and sampled at the
/// same times.
struct ParallelAccelerometer {
  std::string name;
  std::array<std::vector<double>, 3> accel_mps2;
  AccelFigures figures{};
};

/// Measurements of the sensor, in SI. Series of a missing axis are empty.
struct TrackSensor {
  std::string name;
  std::vector<double> time_s;                     ///< ascending
  std::array<std::vector<double>, 3> accel_mps2;  ///< NaN where missing
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope, in the same axes; empty: none
  std::vector<ParallelAccelerometer> beside{};    ///< one to three for TrackModel::fused, else none
};

/// Whether the measurements contain gravity: an accelerometer measures 1 g upward at rest, but many
/// programs export data after subtracting their own estimate of it.
enum class GravityContent { unknown, removed, present };

/// A measured position along the axis of the motion, relative to the start.
struct PositionFix {
  double time_s = 0.0;
  double position_m = 0.0;
  double std_m = 0.0;
};

/// What the fixes contradict.
struct FixReview {
  std::size_t false_rests = 0;       ///< quiet stretches that are no rests
  std::vector<PositionFix> wrong{};  ///< not used
  std::optional<Uncertain>
      delay_s{};  ///< by which the times of the fixes were late, if it is clear
};

struct TimeSpan {
  double start_s = 0.0, end_s = 0.0;
};

enum class TrackModel {
  inertial,  ///< the acceleration is known input between stops
  pva,       ///< it is a measured state driven by white jerk: see track/pva.hpp
  fused,     ///< as pva, measured by several accelerometers
};

struct TrackOptions {
  TrackModel model = TrackModel::inertial;
  /// White jerk of the models pva and fused, two-sided density; absent: by maximum likelihood.
  std::optional<double> jerk_psd_m2ps5 = std::nullopt;
  std::array<std::optional<double>, 3> warm_up_time_s{};  ///< as in AccelFigures; pva and fused
  double gravity_mps2 = standard_gravity_mps2;
  GravityContent gravity = GravityContent::unknown;  ///< unknown: determined from the rests
  /// Direction of the displacement in the sensor's axes, any length; with a gyroscope in world
  /// axes. Absent: the direction of the largest displacement.
  std::optional<std::array<double, 3>> axis = std::nullopt;
  bool same_place = false;           ///< the end position equals the start position
  double same_place_std_m = 1e-3;    ///< standard deviation of that constraint
  std::vector<PositionFix> fixes{};  ///< ascending in time
  std::vector<TimeSpan> still{};     ///< known static intervals, instead of the detected rests
  bool only_end_rests = false;       ///< use only the first and the last detected rest
  std::vector<double> turns_s{};     ///< turning points given by the user: velocity 0
  std::optional<double> shortest_rest_s = std::nullopt;  ///< as in signal::RestOptions
  double rest_speed_std_mps = 1e-4;                      ///< velocity of a sensor at rest
  /// From the sensor file, per axis; absent: white noise from the rests, no random walk.
  std::array<std::optional<double>, 3> white_mps2_rthz{}, walk_mps2_rts{};
  /// Relative scale uncertainty; absent: see notes.
  std::optional<double> scale_std = std::nullopt;
  bool take_as_acceleration = false;  ///< accept the data as acceleration despite contrary evidence
  Progress progress = {};
};

/// Result of one method for the whole recording, along the axis.
struct TrackMethod {
  Uncertain displacement_m;            ///< from the first sample to the last
  double path_m = 0.0;                 ///< path length, outward and return
  std::optional<double> path_std_m{};  ///< absent if not computed
  Uncertain peak_m;                    ///< largest distance from the start, with its sign
  /// Half the width of the 95 % interval of the displacement.
  double half_width_95_m = 0.0;
};

/// A movement to a turning point and straight back, or one way from rest to rest.
struct Stroke {
  std::size_t first = 0, turn = 0, last = 0;  ///< samples; turn equals last for one way
  double start_s = 0.0, turn_s = 0.0, end_s = 0.0;
  Uncertain out_m;                  ///< signed
  std::optional<Uncertain> back_m;  ///< absent for one way
  /// Mean of the two ways; the shorter one if the other is at least half as long again, since it
  /// then includes picking up or laying down the sensor.
  Uncertain length_m;
};

/// Position uncertainty from the sensor, the duration and the constraints, independent of the
/// motion: one standard deviation, from the noise at rest and the random walk of the bias alone.
struct TrackBudget {
  double white_mps2_rthz = 0.0;   ///< along the axis, two-sided
  double walk_mps2_rts = 0.0;     ///< random walk of the bias
  double longest_motion_s = 0.0;  ///< between two stops
  double motion_s = 0.0;          ///< total duration of motion
  std::optional<double> free_m;   ///< at the end, double integration from the start
  std::optional<double> worst_m;  ///< with all constraints, at the widest point of the band
  std::optional<double> end_m;    ///< with all constraints, at the end
};

/// One value for each sample.
struct TrackSeries {
  std::vector<double> time_s;
  std::vector<double> position_m, position_std_m;  ///< given all measurements
  std::vector<double> velocity_mps, velocity_std_mps;
  std::vector<double> filtered_position_m, filtered_position_std_m;  ///< given those so far
  std::vector<double> filtered_velocity_mps;
  std::vector<double> double_integral_m;
  std::vector<double> accel_mps2;  ///< along the axis, minus the level of the rests
  std::vector<unsigned char> resting;
};

/// Acceleration errors in motion beyond the noise at rest: bias, attitude and the end of rests;
/// posterior means.
struct MotionErrorFigures {
  double walk_mps2_rts = 0.0;   ///< random walk
  double jump_mps2 = 0.0;       ///< change of level relative to rest
  double lean_mps2_rthz = 0.0;  ///< rocking of the sensor
};

/// Error of the velocity integrated from one stop to the next, at the second stop.
struct Closure {
  double start_s = 0.0, end_s = 0.0;  ///< of the motion
  double velocity_mps = 0.0;          ///< closure velocity, along the axis
  double expected_std_mps = 0.0;
  double fastest_mps = 0.0;  ///< maximum on the way, in the forward filter
};

/// One of several accelerometers, and its result alone.
struct FusedSensor {
  std::string name;
  Uncertain bias_mps2;  ///< level along the axis at rest at the end, gravity component included
  Uncertain displacement_m;
};

struct FusedTrack {
  std::vector<FusedSensor> sensors;
  /// Smallest displacement variance of a single sensor over the fused one.
  double variance_gain = 1.0;
};

/// Result if these quiet stretches are not rests.
struct TrackAlternative {
  double probability = 0.0;
  std::vector<TimeSpan> no_rests{};
  Uncertain displacement_m{};
};

struct TrackSolution {
  TrackModel model = TrackModel::inertial;
  std::optional<Uncertain> jerk_psd_m2ps5;  ///< as used; std 0 if given; absent: not determined
  std::optional<FusedTrack> fused;          ///< for the model `fused`
  std::array<double, 3> axis{};             ///< unit vector; in the sensor's axes, or world axes
  bool axis_in_world = false;               ///< world axes are known from a gyroscope: z is up
  bool axis_given = false;
  double travel_share = 1.0;  ///< share of the squared velocity along the axis
  GravityContent gravity = GravityContent::unknown;
  std::vector<signal::Rest> rests;
  /// Detected by contrast with the motion, not by the noise of a sensor.
  bool rests_by_quietness = false;
  std::size_t cruises = 0;   ///< quiet stretches that are not rests: constant speed
  std::size_t plateaus = 0;  ///< quiet stretches with constant acceleration
  /// Several interpretations of the quiet stretches remain: no method has a result.
  std::vector<TrackAlternative> alternatives{};
  /// More ambiguous quiet stretches than can be compared: no result either.
  bool too_many_in_doubt = false;
  /// The whole recording is as quiet as rest: only its ends are used as rests.
  bool no_motion_shown = false;
  std::size_t false_rests = 0;  ///< short rests contradicted by the motion between the long ones
  FixReview fix_review{};
  bool suspected_jerk = false;  ///< true: no method has a result
  std::optional<TrackMethod> double_integration, kalman, smoother;
  std::vector<Stroke> strokes;
  MotionErrorFigures motion_error;  ///< estimated from the closures; zeros with a gyroscope
  double factor_95 = 1.96;          ///< half width of a 95 % interval in standard deviations
  double scale_std = 0.0;  ///< relative, as used; part of every band, proportional to the distance
  std::optional<double> resting_norm_mps2;  ///< norm of the measurements at rest, with three axes
  std::optional<double> turned_rad;         ///< largest angle between gravity at two rests
  std::size_t missing = 0;                  ///< samples without a measurement
  TrackBudget budget;
  std::vector<Closure> closures;
  Consistency consistency;
  TrackSeries series;
  std::vector<Note> notes;
};

/// Displacement along the motion's own axis.
///
/// - Between stops the accelerometer is the input: v' = a − b, p' = v, with the bias b (and the
///   component of gravity along the axis) a random walk.
/// - At a stop the velocity is 0 and the accelerometer measures b.
/// - The random walk in motion has a posterior from the closures: the closure velocity at each stop
///   and the change of level.
///
/// A forward filter and its fixed-interval smoother run over that model; double integration is
/// computed for comparison.
///
/// Source: see docs/methods/track.md. Errors: invalid_argument, too_few_samples, not_observable (no
/// stop and no fix; the measurements cannot be accelerations).
[[nodiscard]] Result<TrackSolution> estimate_track(const TrackSensor& sensor,
                                                   const TrackOptions& options);

}  // namespace proofmass::estimate
