#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/model_equation.hpp"
#include "proofmass/sensor/sensor_model.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/slide.hpp"

// What is done with one three-axis accelerometer, as a digital twin: its calibration by a table
// that turns it in steps, or by a hand that lays it down in one position after another; and its
// use, on a carriage that goes along a line.
namespace proofmass::simulate {

enum class Procedure {
  tumble,          ///< a table about a horizontal axis, evenly spaced positions
  four_position,   ///< the thesis's: 0°, 90°, 180°, 270°
  six_position,    ///< by hand: x, −x, y, −y, z, −z upwards
  multi_position,  ///< by hand: a long rest, then positions all over the sphere
  slide,           ///< carried along a straight line, with rests between the strokes
};

/// "tumble", "four-position", "six-position", "multi-position", "slide".
[[nodiscard]] std::string_view name_of(Procedure procedure);
[[nodiscard]] std::optional<Procedure> procedure_named(std::string_view name);

/// The sensor. Its reading of the force f is, by axis, u = output of the model equation, with
///
///     K1 = scale · equation.K1,   K0 = bias/scale + equation.K0,   δ = that of T⁻¹ + equation.δ,
///
/// T of sensor::Calibration, so that either the nine parameters, or the equations, or both can be
/// given; all else is the equation's. The input axis i being x, y or z, the pendulous axis p and
/// the output axis o are the next two: y z, z x, x y. On the reading come bias drift and noise; it
/// stops at ± full_scale.
struct ProcedureSensor {
  Axes bias_mps2{};
  Axes scale{1.0, 1.0, 1.0};
  Axes misalignment_rad{};                        ///< α_yz, α_zy, α_zx
  std::array<sensor::ModelEquation, 3> equation;  ///< of the axes x, y, z
  /// The seed adds an even draw of ± these to the above.
  double bias_spread_mps2 = 0.3, scale_spread = 0.02, misalignment_spread_rad = 0.01;

  double full_scale_mps2 = *sensor::adxl335.full_scale_mps2.typ;
  Axes noise_rms_mps2{0.0184, 0.0184, 0.0184};  ///< independent from sample to sample
  Axes flicker_mps2{5e-4, 5e-4, 5e-4};          ///< B of sensor::NoiseModel
  Axes bias_walk_mps2_rts{2e-5, 2e-5, 2e-5};    ///< K of sensor::NoiseModel
  Axes warm_up_mps2{};                          ///< rises as 1 − e^(−t/warm_up_time)
  double warm_up_time_s = 60.0;
  Axes ramp_mps2ps{};  ///< grows with the time since the first sample

  double sensitivity_v_per_mps2 = 0.330 / standard_gravity_mps2;  ///< at the reference supply
  double zero_g_fraction = 0.5;                                   ///< of the supply
  /// How far it is from ratiometric: reading (1 + scale_per_v ΔV) + bias_per_v ΔV, ΔV the supply
  /// less the reference.
  Axes scale_per_v{}, bias_per_v_mps2pv{};
};

/// When it moves and when it lies still.
struct ProcedureTiming {
  double dwell_s = 4.0;  ///< from standing to the next move, settling included
  double move_s = 2.0;   ///< of a slide: a stroke
  double dwell_jitter = 0.0, move_jitter = 0.0;  ///< even draws of ± these fractions
  double settle_s = 0.6;                         ///< a dying swing after each move, then exact rest
  double settle_mps2 = 0.3, settle_hz = 14.0;
};

enum class TableAxis { x, y, z };

/// The table. With its angle θ, at which its first axis is above the horizontal, the force along
/// its axes is
///
///     g (sinθ cosβ, cosθ cosβ, sinβ) − ω² p + α e_z × p,
///
/// β the third axis's tilt, p = (radius, 0, 0). With the sensor's input axis i, pendulous axis p
/// and output axis o the table's axes are, in plane 1, i p o, in plane 2, i o −p; turned on the
/// table, the first two point the other way.
struct ProcedureTable {
  TableAxis input_axis = TableAxis::x;
  int positions = 24;       ///< evenly over a turn
  bool closing = true;      ///< the first position once more at the end of each turn
  int planes = 1;           ///< the last one: 1 or 2
  int first_plane = 1;      ///< 1 or 2
  bool backward = false;    ///< each turn is followed by one the other way
  bool turned = false;      ///< the sensor is first mounted turned by 180° on the table
  bool remounted = false;   ///< and each plane comes again the other way
  double remount_s = 20.0;  ///< by hand
  /// True angle less commanded angle c, of the table's own scale:
  ///     zero_error + once cos(c − once_phase) + twice cos(2 c − twice_phase)
  ///         + a draw for each position + a draw for each setting ± backlash/2 (forward: −).
  double zero_error_rad = 0.0;
  double once_rad = 0.0, once_phase_rad = 0.0;
  double twice_rad = 0.0, twice_phase_rad = 0.0;
  double position_std_rad = 0.0, setting_std_rad = 0.0, backlash_rad = 0.0;
  double axis_tilt_rad = 0.0;
  double mounting_std_rad = 0.0;  ///< of each mounting's small turn about each axis
  double radius_m = 0.02;         ///< of the sensor from the table's axis
  double vibration_mps2 = 0.05;   ///< rms while it moves, up to 20 Hz
  bool angle_recorded = true;     ///< the commanded angle, as a channel "angle"
  bool angle_follows = false;     ///< which moves with the table, as an encoder's; else steps ahead
};

/// The hand.
struct ProcedureHand {
  int poses = 24;                ///< multi-position; Fibonacci directions in a drawn order
  double initial_rest_s = 20.0;  ///< lying with z up, before them; 0: none
  double placement_std_rad = 5.0 * rad_per_deg;  ///< about two axes
  double lift_m = 0.08;                          ///< up and down again
  double sway_rms_mps2 = 0.8;                    ///< up to 3 Hz
  double tremor_rms_mps2 = 0.25;                 ///< 8 to 12 Hz
  double wobble_rms_rad = 4.0 * rad_per_deg;     ///< about the shortest turn, up to 2 Hz
  double bump_mps2 = 5.0;                        ///< of setting it down, and of some knocks
  int bad_pose = 0;                              ///< number of the one that is disturbed; 0: none
  double bad_pose_push_mps2 = 0.0;               ///< by which |f| is then greater
};

struct ProcedureSupply {
  double reference_v = 3.3;  ///< by which an output in m/s^2 is reckoned
  double actual_v = 3.3;
  bool recorded = false;  ///< as a channel "supply"
};

/// What is to be simulated; default_options() has the defaults of each procedure.
struct ProcedureOptions {
  Procedure procedure = Procedure::multi_position;
  std::uint64_t seed = 1;
  /// Another session of the same sensor on the same table: other noise, drift and hand.
  std::uint64_t session = 0;
  double rate_hz = 100.0;
  double gravity_mps2 = standard_gravity_mps2;
  RigOutput output = RigOutput::acceleration;
  bool labelled = false;  ///< the rests as labels of the recording
  ProcedureTiming timing;
  ProcedureTable table;
  ProcedureHand hand;
  ProcedureSlide slide;
  ProcedureSupply supply;
  RigDaq daq;  ///< skew_s is not used
  ProcedureSensor sensor;
};

[[nodiscard]] ProcedureOptions default_options(Procedure procedure);

/// One position at rest, as it truly was.
struct TruePose {
  std::size_t number = 0;                                ///< 1, 2, …
  double start_s = 0.0, end_s = 0.0;                     ///< of exact rest
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< in the sensor's axes
  /// Table only: plane, 0 or π by which the sensor is turned on the table, and the table's angle.
  int plane = 0;
  double mount_rad = 0.0, commanded_rad = 0.0, angle_rad = 0.0;
};

/// What the seed has drawn.
struct ProcedureTruth {
  std::vector<TruePose> poses;
  /// Of a slide: its strokes, and the line's direction in the sensor's axes at the first rest.
  std::vector<TrueStroke> strokes;
  Eigen::Vector3d line = Eigen::Vector3d::Zero();
  /// Of the axes x, y, z, with the output in the recording's unit, at the actual supply; drift is
  /// not in it.
  std::array<sensor::ModelEquation, 3> equations;
  /// Of the drift over the rests, which every calibration takes for bias; m/s² on the reading.
  Axes mean_drift_mps2{};
  /// What brings the recording to force, as far as nine parameters can; see RigResult::sensors.
  sensor::SensorModel sensor;
};

struct ProcedureResult {
  /// Channels acc_x, acc_y, acc_z and, of a table, angle (deg), where there are several plane and
  /// mount (deg); of a slide gyro_x, … and acc2_x, … if asked for; if asked for supply.
  Recording recording;
  /// force_x, force_y, force_z (m/s^2), bias_x, … (m/s^2: the drift on the reading), angle (rad,
  /// table only), rest (1 at rest, else 0), position (its number, else 0), at the samples. Of a
  /// slide, in place of position: displacement (m), velocity and acceleration along the line, turn
  /// (rad, from the first rest) and stroke (its number, else 0).
  Recording truth_series;
  ProcedureTruth truth;
};

/// Simulates the procedure.
/// Errors: invalid_argument (the message names the option). Same options, same numbers.
[[nodiscard]] Result<ProcedureResult> simulate_procedure(const ProcedureOptions& options,
                                                         const Progress& progress = {});

/// The mean of one position, without the samples behind it.
struct PoseMean {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< in the recording's unit
  /// Of the mean, by white noise alone.
  Eigen::Vector3d white_std = Eigen::Vector3d::Zero();
  std::size_t samples = 0;
};

struct PoseMeans {
  std::vector<PoseMean> means;  ///< of truth.poses
  ProcedureTruth truth;
};

/// The means over the rests of the same procedure, drawn directly with the distribution that those
/// of the samples have: white noise, flicker, random walk, warm-up and ramp. The converter's
/// rounding is left out. Another trial is another draw of the noise alone: sensor and positions
/// hang on the seed.
/// Errors: as simulate_procedure. Cost: O(poses).
[[nodiscard]] Result<PoseMeans> draw_pose_means(const ProcedureOptions& options,
                                                std::size_t trial = 0);

/// The error of an option if there is one, without simulating.
[[nodiscard]] Status check(const ProcedureOptions& options);

}  // namespace proofmass::simulate
