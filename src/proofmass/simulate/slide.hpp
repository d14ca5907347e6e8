#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// What a sensor is carried along, where the procedure is a slide: see procedure.hpp.
namespace proofmass::simulate {

enum class SlideProfile {
  minimum_jerk,  ///< 10 s³ − 15 s⁴ + 6 s⁵: stops at every turning point without a force
  harmonic,      ///< (1 − cos πs)/2: turns round at full force, as a bar between two repetitions
};

/// A carriage on a straight line, from rest to rest by strokes. How long a stroke takes and how
/// long it rests stand in ProcedureTiming; the settling of a hand is not used.
///
/// The line's direction is d = (cos e, 0, sin e), e its elevation, in axes of which z is upwards;
/// the sensor stands in them as R = Rz(yaw) Ry(pitch) Rx(roll), hence feels
///
///     f = Rᵀ (a d + g z) + α × r + ω × (ω × r),   r its place on the carriage.
struct ProcedureSlide {
  int strokes = 6;             ///< or sets of them, each followed by a rest
  int repetitions = 0;         ///< 0: a stroke is one way; n: there and back n times without a rest
  bool returning = true;       ///< one-way strokes go there and back in turn, else ever further
  double length_m = 0.4;       ///< of a stroke; negative: it begins downwards
  double length_jitter = 0.0;  ///< even draw of ± this fraction
  double turn_pause_s = 0.0;   ///< standing between there and back within a set
  double initial_rest_s = 4.0, final_rest_s = 4.0;
  SlideProfile profile = SlideProfile::minimum_jerk;
  double elevation_rad = 0.0;                             ///< of the line above the horizontal
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;  ///< how the sensor is mounted
  bool any_mounting = false;     ///< the seed draws the mounting, evenly over all of them
  double turn_std_rad = 0.0;     ///< by which each rest differs from the mounting, about each axis
  double wobble_rms_rad = 0.0;   ///< about each axis while it moves, up to 2 Hz
  double vibration_mps2 = 0.0;   ///< rms along each axis while it moves, 8 to 12 Hz
  bool gravity_removed = false;  ///< its true share is taken out of the recording, as phones do
  bool gyro = false;             ///< channels gyro_x, gyro_y, gyro_z, rad/s
  Axes gyro_bias_radps{};
  double gyro_bias_spread_radps = 0.5 * rad_per_deg;  ///< the seed adds an even draw of ± this
  double gyro_noise_rms_radps = 0.05 * rad_per_deg;   ///< of each sample
  double gyro_walk_radps_rts = 0.001 * rad_per_deg;   ///< random walk of the bias in one second
  /// A second sensor of the same kind beside it: channels acc2_x, acc2_y, acc2_z.
  bool second_sensor = false;
  Axes second_place_m{0.1, 0.0, 0.0};  ///< r of it, in the sensor's axes; of the first r = 0
};

/// One way along the line, as it truly was.
struct TrueStroke {
  std::size_t number = 0;  ///< 1, 2, …
  std::size_t set = 0;     ///< 1, 2, …: between the same two rests
  double start_s = 0.0, end_s = 0.0;
  double from_m = 0.0, to_m = 0.0;  ///< along the line
};

}  // namespace proofmass::simulate
