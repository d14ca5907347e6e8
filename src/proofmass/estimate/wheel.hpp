#pragma once

#include <array>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/estimate/consistency.hpp"
#include "proofmass/signal/encoder.hpp"

// Wheel angle from one or two accelerometers mounted on it.
namespace proofmass::estimate {

/// One accelerometer on the wheel: its measurements, in SI.
struct WheelSensor {
  std::string name;  ///< file, or file and channels
  std::vector<double>
      time_s;  ///< ascending; two sensors share one clock, or clocks_shared is false
  /// Specific force along x, y, z, as long as time_s; NaN where missing. z is empty for a two-axis
  /// sensor, whose x and y then lie in the plane of the wheel.
  std::array<std::vector<double>, 3> accel_mps2;
  /// Angular rate in the same axes, as long as time_s; empty without a gyroscope, NaN where
  /// missing.
  std::array<std::vector<double>, 3> rate_radps{};
};

/// An encoder on the axle, on the clock of the first sensor.
struct WheelEncoder {
  std::string name;          ///< of its channel
  signal::AngleFixes fixes;  ///< its own angle, of any zero and direction
  double step_rad = 0.0;     ///< width of a count; 0: no visible steps
  /// Calibrated errors (c, s) once and twice a turn: ψ = θ + Σ c_n cos nψ + s_n sin nψ, with ψ = 0
  /// as in the calibration. Default: a disc off centre by about a twentieth of its radius.
  std::optional<std::array<Uncertain, 4>> errors_rad{};
  /// Standard deviation of the accelerometers' nonlinearity at 1 g: it resembles the errors once
  /// and twice a turn (docs/methods/encoder.md).
  double nonlinearity = 2e-4;
};

struct WheelOptions {
  double gravity_mps2 = standard_gravity_mps2;
  /// Spin axis in the axes of each sensor, any length; estimated from the data if not given.
  std::optional<std::array<double, 3>> spin_axis;
  std::optional<double> radius_m;      ///< distance of each sensor from the axle, if known
  std::optional<double> radius_std_m;  ///< its standard deviation; default: 2 %, at least 0.2 mm
  /// Radius of the circle whose path is the distance travelled.
  std::optional<double> rim_radius_m;
  /// Rolling radius of a vehicle's wheel, if known, to 3 %; 0 for a bench. It corrects the angle
  /// for the vehicle's acceleration. Default: 0.2 ± 0.12 m if the hub shakes, else 0 ± 0.05 m.
  std::optional<double> rolling_radius_m;
  /// −3 dB bandwidth of the sensors' one-pole filter, which delays the measured gravity vector.
  /// Default: a corner between 6 Hz (0.06 of the rate, if that is lower) and 2.5 times the rate.
  std::optional<double> bandwidth_hz;
  double axle_tilt_std_rad = 5.0 * std::numbers::pi / 180.0;  ///< inclination of the axle
  /// Standard deviation of the angle between a sensor's axes and the marks of the wheel. It is not
  /// observable with accelerometers; it is part of the band of every angle, but not of the number
  /// of turns.
  double alignment_std_rad = 0.0;
  bool clocks_shared = true;  ///< false: two sensors with unrelated clocks
  std::optional<WheelEncoder> encoder{};
  Progress progress;
};

/// Result of one estimator for the whole recording.
struct WheelMethod {
  std::optional<Uncertain> turns;  ///< std is 0 if the method gives none
  std::string note;                ///< the reason for a missing result, or its limitation
};

/// The sensor parameters estimated from the recording. Absent values are explained in
/// WheelSolution::notes.
struct WheelSensorFit {
  std::string name;
  std::array<double, 3> spin_axis{};  ///< unit vector in the sensor's axes
  bool spin_axis_given = false;
  std::optional<Uncertain> radius_m;      ///< from the axle to the sensor's proof mass
  std::optional<Uncertain> mounting_rad;  ///< sensor's first in-plane axis against the spoke
  /// Along the two in-plane axes, measurement = scale · force + bias.
  std::array<std::optional<Uncertain>, 2> bias_mps2, scale;
  std::optional<Uncertain> skew_rad;        ///< non-orthogonality of the in-plane axes
  std::optional<Uncertain> phase_rad;       ///< second sensor against the first, about the axle
  std::optional<Uncertain> clock_offset_s;  ///< second sensor's clock against the first's
  bool has_gyro = false;                    ///< the turns were counted with it
  /// Gyroscope about the axle: measurement = scale · speed + bias.
  std::optional<Uncertain> gyro_scale, gyro_bias_radps;
  double noise_mps2 = 0.0;  ///< per sample and axis, at rest or in the quietest part
  std::size_t samples = 0;
  std::size_t unusable = 0;  ///< rows dropped before the filter: not finite, or implausible
  std::size_t gated = 0;     ///< rows rejected by the gate
};

/// The encoder as estimated from the recording: d ψ = θ + o + d Σ c_n cos nψ + s_n sin nψ.
struct WheelEncoderFit {
  std::string name;
  double direction = 1.0;               ///< d; −1 if its angle falls where the wheel's rises
  std::optional<Uncertain> offset_rad;  ///< o at the end, within half a turn
  std::array<std::optional<Uncertain>, 4> errors_rad{};  ///< c₁, s₁, c₂, s₂
  double noise_rad = 0.0;  ///< standard deviation of one of its angles, from counts and innovations
  std::vector<signal::CountSlip> missed;  ///< counts missed at once, which were added again
};

/// One value for each epoch of the merged time line; `angle` counts turns, 0 = first in-plane axis
/// of the first sensor horizontal, positive about the spin axis.
struct WheelSeries {
  std::vector<double> time_s;
  std::vector<double> angle_rad, angle_std_rad;  ///< smoother: given all measurements
  std::vector<double> speed_radps, speed_std_radps;
  std::vector<double> accel_radps2, accel_std_radps2;
  /// Given the measurements so far, with the sensors calibrated by the whole recording.
  std::vector<double> filtered_angle_rad, filtered_angle_std_rad;
  std::vector<double> atan2_angle_rad;            ///< plain gravity phase, unwrapped
  std::vector<double> double_integral_angle_rad;  ///< empty if the radius is unknown
  std::vector<float> nis;                         ///< per epoch, over its channels
  std::vector<unsigned char> channels_used;       ///< degrees of freedom of each nis; 0 = none used
  std::vector<unsigned char> channels_gated;
};

/// A time interval, for lists of rejected or lost data.
struct Stretch {
  double start_s = 0.0, end_s = 0.0;
  std::size_t rows = 0;
  std::string reason;
};

/// A number of turns consistent with the recording.
struct TurnsCandidate {
  Uncertain turns;
  double probability = 0.0;
};

struct WheelSolution {
  std::optional<Uncertain> turns;  ///< signed, about the spin axis of the first sensor
  /// If the count is ambiguous and `turns` is absent: the possible counts, by falling probability.
  std::vector<TurnsCandidate> turns_candidates;
  /// Path of the rim if its radius, or the rolling radius, is given or estimated; else of the first
  /// sensor.
  std::optional<Uncertain> distance_m;
  std::string distance_of;  ///< "rim" or the sensor's name
  std::optional<Uncertain> angle_final_rad;
  std::optional<Uncertain> peak_speed_radps;
  Uncertain delay_s{};  ///< of the sensors' filters, as given or as estimated
  /// As estimated, with a gyroscope or an encoder on a vehicle whose speed changes; absent if
  /// given.
  std::optional<Uncertain> rolling_radius_m;
  std::vector<WheelSensorFit> sensors;
  std::optional<WheelEncoderFit> encoder;
  WheelMethod double_integration, atan2, ekf, smoother;
  Consistency consistency;
  std::size_t rejected_samples = 0;  ///< rows of any sensor that no estimate used
  std::vector<Stretch> rejected;     ///< the same, as time intervals
  std::vector<std::string>
      not_observable;  ///< sentences: what this recording does not determine, and what would
  std::vector<Note> notes;
  WheelSeries series;
};

/// Angle, speed and acceleration of a wheel from one or two accelerometers anywhere on it, with the
/// sensors' biases, scales, radii and mounting angles as far as they are observable. The memory of
/// two sensors is freed as soon as they are merged: move long ones.
///
/// Errors: invalid_argument (no sensor, unequal lengths, an axis of length 0, non-ascending time),
/// too_few_samples, not_observable (no spin axis can be found, gravity does not rotate with the
/// encoder's angle, or without an encoder no sensor has measurements for more than a minute).
[[nodiscard]] Result<WheelSolution> estimate_wheel(std::vector<WheelSensor> sensors,
                                                   const WheelOptions& options);

}  // namespace proofmass::estimate
