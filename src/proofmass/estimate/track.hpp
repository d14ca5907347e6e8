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

// Displacement of one accelerometer that is carried along, from rest to rest.
namespace proofmass::estimate {

/// What else a sensor file says of an accelerometer, per axis.
struct AccelFigures {
  /// Absent: white noise from the rests, no walk.
  std::array<std::optional<double>, 3> white_mps2_rthz{}, walk_mps2_rts{};
  /// Of its warm-up, whose known course is taken out of the readings; absent: the bias walks.
  std::array<std::optional<double>, 3> warm_up_time_s{};
};

/// Accelerometers with parallel axes that `fused` takes, the first included.
inline constexpr std::size_t most_fused_sensors = 4;

/// A further accelerometer on the same body, its axes parallel to those of the first, read at the
/// same times.
struct ParallelAccelerometer {
  std::string name;
  std::array<std::vector<double>, 3> accel_mps2;
  AccelFigures figures{};
};

/// What the sensor read, in SI. Series of an axis that the sensor lacks are empty.
struct TrackSensor {
  std::string name;
  std::vector<double> time_s;                     ///< ascending
  std::array<std::vector<double>, 3> accel_mps2;  ///< NaN where there is no reading
  std::array<std::vector<double>, 3> rate_radps;  ///< gyroscope, in the same axes; empty: none
  std::vector<ParallelAccelerometer> beside{};    ///< one to three for TrackModel::fused, else none
};

/// Whether the readings hold gravity: an accelerometer reads 1 g upward at rest, but many programs
/// export what is left after taking their own estimate of it out.
enum class GravityContent { unknown, removed, present };

/// A position that somebody measured, along the axis of the motion, counted from the start.
struct PositionFix {
  double time_s = 0.0;
  double position_m = 0.0;
  double std_m = 0.0;
};

struct TimeSpan {
  double start_s = 0.0, end_s = 0.0;
};

enum class TrackModel {
  inertial,  ///< the acceleration is known input between stops
  pva,       ///< it is a state that white jerk drives, and is measured: see track_pva.hpp
  fused,     ///< the same, measured by several accelerometers
};

struct TrackOptions {
  TrackModel model = TrackModel::inertial;
  /// White jerk of the models pva and fused, two-sided density; absent: by maximum likelihood.
  std::optional<double> jerk_psd_m2ps5 = std::nullopt;
  std::array<std::optional<double>, 3> warm_up_time_s{};  ///< as of AccelFigures; pva and fused
  double gravity_mps2 = standard_gravity_mps2;
  GravityContent gravity = GravityContent::unknown;  ///< unknown: told from the rests
  /// Direction of the displacement in the sensor's axes, any length; with a gyroscope in those of
  /// the world. Absent: that along which the sensor moved farthest.
  std::optional<std::array<double, 3>> axis = std::nullopt;
  bool same_place = false;           ///< it ended where it began
  double same_place_std_m = 1e-3;    ///< how well
  std::vector<PositionFix> fixes{};  ///< ascending in time
  std::vector<TimeSpan> still{};     ///< when it stood still, in place of the rests that are found
  bool only_end_rests = false;    ///< of the rests that are found only the first and the last are
  std::vector<double> turns_s{};  ///< where the user says that it turned round: velocity 0
  std::optional<double> shortest_rest_s = std::nullopt;  ///< as of signal::RestOptions
  double rest_speed_std_mps = 1e-4;                      ///< of a sensor that lies still
  /// Of the sensor file, per axis; absent: white noise from the rests, no walk.
  std::array<std::optional<double>, 3> white_mps2_rthz{}, walk_mps2_rts{};
  std::optional<double> scale_std = std::nullopt;  ///< relative, of the readings; absent: see notes
  bool take_as_acceleration = false;               ///< though it looks like something else
  Progress progress = {};
};

/// What one method says of the whole recording, along the axis.
struct TrackMethod {
  Uncertain displacement_m;            ///< from the first sample to the last
  double path_m = 0.0;                 ///< there and back counted both
  std::optional<double> path_std_m{};  ///< absent where it was not worked out
  Uncertain peak_m;                    ///< largest distance from the start, with its sign
  /// Half the width of the 95 % interval of the displacement.
  double half_width_95_m = 0.0;
};

/// A movement away from a turning point and straight back, or one way from rest to rest.
struct Stroke {
  std::size_t first = 0, turn = 0, last = 0;  ///< samples; turn is last where it is one way
  double start_s = 0.0, turn_s = 0.0, end_s = 0.0;
  Uncertain out_m;                  ///< with its sign
  std::optional<Uncertain> back_m;  ///< absent where it is one way
  /// Mean of the two ways; of the shorter where one is half as long again: it was taken up from
  /// elsewhere, or laid down there.
  Uncertain length_m;
};

/// What the sensor, this duration and these constraints allow, before the motion is looked at: one
/// standard deviation, from the noise at rest and the walk of the bias alone.
struct TrackBudget {
  double white_mps2_rthz = 0.0;   ///< along the axis, two-sided
  double walk_mps2_rts = 0.0;     ///< of the bias
  double longest_motion_s = 0.0;  ///< between two stops
  double motion_s = 0.0;          ///< in all
  std::optional<double> free_m;   ///< integrated twice from the start, at the end
  std::optional<double> worst_m;  ///< with all constraints, where the band is widest
  std::optional<double> end_m;    ///< with all constraints, at the end
};

/// One value for each sample.
struct TrackSeries {
  std::vector<double> time_s;
  std::vector<double> position_m, position_std_m;  ///< given all readings
  std::vector<double> velocity_mps, velocity_std_mps;
  std::vector<double> filtered_position_m, filtered_position_std_m;  ///< given those so far
  std::vector<double> filtered_velocity_mps;
  std::vector<double> double_integral_m;
  std::vector<double> accel_mps2;  ///< along the axis, less the level of the rests
  std::vector<unsigned char> resting;
};

/// What the acceleration errs by in motion beyond its noise at rest: of the bias, of the attitude
/// and of the rests' end; mean of the posterior.
struct MotionErrorFigures {
  double walk_mps2_rts = 0.0;   ///< wanders
  double jump_mps2 = 0.0;       ///< differs from that at rest
  double lean_mps2_rthz = 0.0;  ///< rocks
};

/// What was wrong with the velocity, integrated from one stop to the next, when it got there.
struct Closure {
  double start_s = 0.0, end_s = 0.0;  ///< of the motion
  double velocity_mps = 0.0;          ///< left over, along the axis
  double expected_std_mps = 0.0;
  double fastest_mps = 0.0;  ///< on the way, in the forward filter
};

/// One of several accelerometers, and what it would have told alone.
struct FusedSensor {
  std::string name;
  Uncertain bias_mps2;  ///< what it reads along the axis at rest in the end, gravity's share too
  Uncertain displacement_m;
};

struct FusedTrack {
  std::vector<FusedSensor> sensors;
  double variance_gain = 1.0;  ///< smallest variance of a displacement of theirs over the fused one
};

/// What the recording says if these quiet stretches are no rests.
struct TrackAlternative {
  double probability = 0.0;
  std::vector<TimeSpan> no_rests{};
  Uncertain displacement_m{};
};

struct TrackSolution {
  TrackModel model = TrackModel::inertial;
  std::optional<Uncertain> jerk_psd_m2ps5;  ///< as used; std 0 where given; absent: not told
  std::optional<FusedTrack> fused;          ///< of the model fused
  std::array<double, 3> axis{};             ///< unit vector; in the sensor's axes, or the world's
  bool axis_in_world = false;               ///< a gyroscope told where the world is: z is up
  bool axis_given = false;
  double travel_share = 1.0;  ///< of the squared velocity that is along the axis
  GravityContent gravity = GravityContent::unknown;
  std::vector<signal::Rest> rests;
  bool rests_by_quietness = false;  ///< found against the motion, not by the noise of a sensor
  std::size_t cruises = 0;          ///< quiet stretches that are none: the speed was constant
  std::size_t plateaus = 0;         ///< and those in which the acceleration was constant
  /// Where several readings of the quiet stretches remain: then no method has a figure.
  std::vector<TrackAlternative> alternatives{};
  bool too_many_in_doubt = false;  ///< more quiet stretches than can be compared: no figure either
  bool no_motion_shown = false;  ///< all of it is as quiet as rest: only its ends are taken for it
  std::size_t false_rests = 0;   ///< short ones that the motion between the long ones belies
  bool suspected_jerk = false;   ///< then no method has a figure
  std::optional<TrackMethod> double_integration, kalman, smoother;
  std::vector<Stroke> strokes;
  MotionErrorFigures motion_error;  ///< found from the closures; zeros with a gyroscope
  double factor_95 = 1.96;          ///< half width of a 95 % interval in standard deviations
  double scale_std = 0.0;  ///< relative, as used; part of every band in proportion to the distance
  std::optional<double> resting_norm_mps2;  ///< length of the readings at rest, of three axes
  std::optional<double> turned_rad;         ///< largest angle between gravity at two rests
  std::size_t missing = 0;                  ///< samples without a reading
  TrackBudget budget;
  std::vector<Closure> closures;
  Consistency consistency;
  TrackSeries series;
  std::vector<Note> notes;
};

/// Displacement along the motion's own axis.
///
/// Between stops the accelerometer is the input: v' = a − b, p' = v, with the bias b (and what of
/// gravity leans into the axis) walking; at a stop the velocity is 0 and the accelerometer reads b.
/// The walk in motion has a posterior from the closures: what velocity was left over at each stop,
/// and how far the level had moved. A forward filter and its fixed-interval smoother run over that;
/// double integration stands beside them.
///
/// Source: see docs/methods/track.md.
/// Errors: invalid_argument, too_few_samples, not_observable (no stop and no fix; the readings
/// cannot be accelerations).
[[nodiscard]] Result<TrackSolution> estimate_track(const TrackSensor& sensor,
                                                   const TrackOptions& options);

}  // namespace proofmass::estimate
