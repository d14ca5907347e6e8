#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// Options of the carriage, if the procedure is a slide: see procedure.hpp.
namespace proofmass::simulate {

enum class SlideProfile {
  minimum_jerk,  ///< 10 s³ − 15 s⁴ + 6 s⁵: zero force at every turning point
  harmonic,      ///< (1 − cos πs)/2: maximum force at the turning points, like a barbell between
                 ///< two repetitions
};

/// A carriage on a straight line, from rest to rest by strokes. The durations of strokes and rests
/// are in ProcedureTiming; settling after manual positioning is not used.
///
/// The line's direction is d = (cos e, 0, sin e), e its elevation, in axes with z upwards. With the
/// attitude of the sensor R = Rz(yaw) Ry(pitch) Rx(roll) the force is
///
///     f = Rᵀ (a d + g z) + α × r + ω × (ω × r),   r its position on the carriage.
struct ProcedureSlide {
  int strokes = 6;             ///< or sets of strokes, each followed by a rest
  int repetitions = 0;         ///< 0: a stroke is one way; n: n times there and back without a rest
  bool returning = true;       ///< one-way strokes alternate in direction, else all go the same way
  double length_m = 0.4;       ///< length of a stroke; negative: it begins downwards
  double length_jitter = 0.0;  ///< uniform draw of ± this fraction
  double turn_pause_s = 0.0;   ///< pause between there and back within a set
  double initial_rest_s = 4.0, final_rest_s = 4.0;
  SlideProfile profile = SlideProfile::minimum_jerk;
  double elevation_rad = 0.0;                             ///< angle above the horizontal
  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;  ///< mounting of the sensor
  bool any_mounting = false;     ///< the seed draws the mounting, uniformly over all rotations
  double turn_std_rad = 0.0;     ///< rotation of each rest from the mounting, per axis
  double wobble_rms_rad = 0.0;   ///< about each axis while moving, up to 2 Hz
  double vibration_mps2 = 0.0;   ///< rms along each axis while moving, 8 to 12 Hz
  bool gravity_removed = false;  ///< true gravity is subtracted from the recording, as phones do
  bool gyro = false;             ///< channels gyro_x, gyro_y, gyro_z, rad/s
  Axes gyro_bias_radps{};
  double gyro_bias_spread_radps = 0.5 * rad_per_deg;  ///< the seed adds a uniform draw of ± this
  double gyro_noise_rms_radps = 0.05 * rad_per_deg;   ///< per sample
  double gyro_walk_radps_rts = 0.001 * rad_per_deg;   ///< random walk of the bias in one second
  /// A second sensor of the same kind: channels acc2_x, acc2_y, acc2_z.
  bool second_sensor = false;
  Axes second_place_m{0.1, 0.0, 0.0};  ///< r of it, in the sensor's axes; for the first r = 0
};

/// True values of one way along the line.
struct TrueStroke {
  std::size_t number = 0;  ///< 1, 2, …
  std::size_t set = 0;     ///< 1, 2, …: strokes between the same two rests
  double start_s = 0.0, end_s = 0.0;
  double from_m = 0.0, to_m = 0.0;  ///< along the line
};

}  // namespace proofmass::simulate
