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

// Digital twin of procedures with one three-axis accelerometer: its calibration by an indexing
// table, or by hand in one position after another; and its use on a carriage that moves along a
// line.
namespace proofmass::simulate {

enum class Procedure {
  tumble,          ///< evenly spaced positions on a table about a horizontal axis
  four_position,   ///< as in the thesis: 0°, 90°, 180°, 270°
  six_position,    ///< by hand: x, −x, y, −y, z, −z upwards
  multi_position,  ///< by hand: a long rest, then positions all over the sphere
  slide,           ///< carried along a straight line, with rests between the strokes
};

/// "tumble", "four-position", "six-position", "multi-position", "slide".
[[nodiscard]] std::string_view name_of(Procedure procedure);
[[nodiscard]] std::optional<Procedure> procedure_named(std::string_view name);

/// The sensor. Its reading of the force f is, per axis, u = output of the model equation, with
///
///     K1 = scale · equation.K1,   K0 = bias/scale + equation.K0,   δ = that of T⁻¹ + equation.δ,
///
/// T of sensor::Calibration: the nine parameters, the equations, or both can be given; all other
/// coefficients are the equation's. For the input axis i = x, y or z, the pendulous axis p and the
/// output axis o are the next two: y z, z x, x y. Bias drift and noise are added to the reading,
/// which is clipped at ± full_scale.
struct ProcedureSensor {
  Axes bias_mps2{};
  Axes scale{1.0, 1.0, 1.0};
  Axes misalignment_rad{};                        ///< α_yz, α_zy, α_zx
  std::array<sensor::ModelEquation, 3> equation;  ///< for the axes x, y, z
  /// The seed adds a uniform draw of ± these to the above.
  double bias_spread_mps2 = 0.3, scale_spread = 0.02, misalignment_spread_rad = 0.01;

  double full_scale_mps2 = *sensor::adxl335.full_scale_mps2.typ;
  Axes noise_rms_mps2{0.0184, 0.0184, 0.0184};  ///< independent from sample to sample
  Axes flicker_mps2{5e-4, 5e-4, 5e-4};          ///< B of sensor::NoiseModel
  Axes bias_walk_mps2_rts{2e-5, 2e-5, 2e-5};    ///< K of sensor::NoiseModel
  Axes warm_up_mps2{};                          ///< grows as 1 − e^(−t/warm_up_time)
  double warm_up_time_s = 60.0;
  Axes ramp_mps2ps{};  ///< proportional to the time since the first sample

  double sensitivity_v_per_mps2 = 0.330 / standard_gravity_mps2;  ///< at the reference supply
  double zero_g_fraction = 0.5;                                   ///< relative to the supply
  /// Deviation from ratiometric: reading (1 + scale_per_v ΔV) + bias_per_v ΔV, ΔV the supply minus
  /// the reference.
  Axes scale_per_v{}, bias_per_v_mps2pv{};
};

/// Durations of motion and rest.
struct ProcedureTiming {
  double dwell_s = 4.0;  ///< from arrival to the next move, settling included
  double move_s = 2.0;   ///< for a slide: one stroke
  double dwell_jitter = 0.0, move_jitter = 0.0;  ///< uniform draws of ± these fractions
  double settle_s = 0.6;                         ///< decaying oscillation after a move, then rest
  double settle_mps2 = 0.3, settle_hz = 14.0;
};

enum class TableAxis { x, y, z };

/// The table. With its angle θ, the angle of its first axis above the horizontal, the force along
/// its axes is
///
///     g (sinθ cosβ, cosθ cosβ, sinβ) − ω² p + α e_z × p,
///
/// β the tilt of the third axis, p = (radius, 0, 0). With the sensor's input axis i, pendulous axis
/// p and output axis o, the table's axes are i p o in plane 1 and i o −p in plane 2; if the sensor
/// is turned on the table, the first two are reversed.
struct ProcedureTable {
  TableAxis input_axis = TableAxis::x;
  int positions = 24;       ///< evenly over a turn
  bool closing = true;      ///< repeats the first position at the end of each turn
  int planes = 1;           ///< number of the last plane: 1 or 2
  int first_plane = 1;      ///< 1 or 2
  bool backward = false;    ///< each turn is followed by one in reverse
  bool turned = false;      ///< the sensor is first mounted turned by 180° on the table
  bool remounted = false;   ///< each plane is repeated with the opposite mounting
  double remount_s = 20.0;  ///< by hand
  /// True angle minus commanded angle c, on the table's own scale:
  ///     zero_error + once cos(c − once_phase) + twice cos(2 c − twice_phase)
  ///         + a draw for each position + a draw for each setting ± backlash/2 (forward: −).
  double zero_error_rad = 0.0;
  double once_rad = 0.0, once_phase_rad = 0.0;
  double twice_rad = 0.0, twice_phase_rad = 0.0;
  double position_std_rad = 0.0, setting_std_rad = 0.0, backlash_rad = 0.0;
  double axis_tilt_rad = 0.0;
  double mounting_std_rad = 0.0;  ///< small rotation about each axis at each mounting
  double radius_m = 0.02;         ///< distance of the sensor from the table's axis
  double vibration_mps2 = 0.05;   ///< rms while moving, up to 20 Hz
  bool angle_recorded = true;     ///< the commanded angle, as a channel "angle"
  bool angle_follows = false;     ///< like an encoder's; else it steps ahead of the table
};

/// Manual positioning.
struct ProcedureHand {
  int poses = 24;                ///< multi-position; Fibonacci directions in random order
  double initial_rest_s = 20.0;  ///< with z up, before the positions; 0: none
  double placement_std_rad = 5.0 * rad_per_deg;  ///< about two axes
  double lift_m = 0.08;                          ///< up and down again
  double sway_rms_mps2 = 0.8;                    ///< up to 3 Hz
  double tremor_rms_mps2 = 0.25;                 ///< 8 to 12 Hz
  double wobble_rms_rad = 4.0 * rad_per_deg;     ///< about the shortest rotation, up to 2 Hz
  double bump_mps2 = 5.0;                        ///< peak of setting it down, and of some shocks
  int bad_pose = 0;                              ///< number of the disturbed position; 0: none
  double bad_pose_push_mps2 = 0.0;               ///< increase of |f| in it
};

struct ProcedureSupply {
  double reference_v = 3.3;  ///< reference for an output in m/s^2
  double actual_v = 3.3;
  bool recorded = false;  ///< as a channel "supply"
};

/// Options of the simulation; default_options() has the defaults of each procedure.
struct ProcedureOptions {
  Procedure procedure = Procedure::multi_position;
  std::uint64_t seed = 1;
  /// Another session of the same sensor on the same table: different noise, drift and handling.
  std::uint64_t session = 0;
  double rate_hz = 100.0;
  double gravity_mps2 = standard_gravity_mps2;
  RigOutput output = RigOutput::acceleration;
  bool labelled = false;  ///< stores the rests as labels of the recording
  ProcedureTiming timing;
  ProcedureTable table;
  ProcedureHand hand;
  ProcedureSlide slide;
  ProcedureSupply supply;
  RigDaq daq;  ///< skew_s is not used
  ProcedureSensor sensor;
};

[[nodiscard]] ProcedureOptions default_options(Procedure procedure);

/// True values of one static position.
struct TruePose {
  std::size_t number = 0;                                ///< 1, 2, …
  double start_s = 0.0, end_s = 0.0;                     ///< exact rest
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< in the sensor's axes
  /// Table only: plane, 0 or π by which the sensor is turned on the table, and the table's angle.
  int plane = 0;
  double mount_rad = 0.0, commanded_rad = 0.0, angle_rad = 0.0;
};

/// Values drawn from the seed.
struct ProcedureTruth {
  std::vector<TruePose> poses;
  /// For a slide: its strokes, and the line's direction in the sensor's axes at the first rest.
  std::vector<TrueStroke> strokes;
  Eigen::Vector3d line = Eigen::Vector3d::Zero();
  /// For the axes x, y, z, with the output in the recording's unit, at the actual supply; drift
  /// excluded.
  std::array<sensor::ModelEquation, 3> equations;
  /// Mean drift over the rests, which every calibration includes in the bias; m/s² on the reading.
  Axes mean_drift_mps2{};
  /// Converts the recording to force, as far as nine parameters can; see RigResult::sensors.
  sensor::SensorModel sensor;
};

struct ProcedureResult {
  /// Channels acc_x, acc_y, acc_z.
  /// - Table: angle (deg), and plane and mount (deg) if there are several.
  /// - Slide: gyro_x, … and acc2_x, … if enabled.
  /// - supply if enabled.
  Recording recording;
  /// Truth at the samples: force_x, force_y, force_z (m/s^2), bias_x, … (m/s^2: the drift on the
  /// reading), angle (rad, table only), rest (1 at rest, else 0), position (its number, else 0).
  /// For a slide, instead of position: displacement (m), velocity and acceleration along the line,
  /// turn (rad, from the first rest) and stroke (its number, else 0).
  Recording truth_series;
  ProcedureTruth truth;
};

/// Simulates the procedure. The same options give the same numbers.
/// Errors: invalid_argument (the message names the option).
[[nodiscard]] Result<ProcedureResult> simulate_procedure(const ProcedureOptions& options,
                                                         const Progress& progress = {});

/// The mean of one position, without its samples.
struct PoseMean {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< in the recording's unit
  /// Standard deviation of the mean due to white noise alone.
  Eigen::Vector3d white_std = Eigen::Vector3d::Zero();
  std::size_t samples = 0;
};

struct PoseMeans {
  std::vector<PoseMean> means;  ///< one per entry of truth.poses
  ProcedureTruth truth;
};

/// The means over the rests of the same procedure, drawn directly from the distribution of the
/// sample means: white noise, flicker, random walk, warm-up and ramp. Quantisation is omitted.
/// Another trial is another draw of the noise alone: sensor and positions depend on the seed.
/// Errors: as simulate_procedure. Cost: O(poses).
[[nodiscard]] Result<PoseMeans> draw_pose_means(const ProcedureOptions& options,
                                                std::size_t trial = 0);

/// The error of an invalid option, without simulating.
[[nodiscard]] Status check(const ProcedureOptions& options);

}  // namespace proofmass::simulate
