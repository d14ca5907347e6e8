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

// The angle of a wheel from one or two accelerometers that turn with it.
namespace proofmass::estimate {

/// One accelerometer on the wheel: what it read, in SI.
struct WheelSensor {
  std::string name;  ///< file, or file and channels
  std::vector<double>
      time_s;  ///< ascending; two sensors share one clock, or clocks_shared is false
  /// Specific force along x, y, z, as long as time_s; NaN where there is no reading. z is empty for
  /// a two-axis sensor, whose x and y then lie in the plane of the wheel.
  std::array<std::vector<double>, 3> accel_mps2;
  /// Angular rate in the same axes, as long as time_s; empty without a gyroscope, NaN at samples
  /// without a reading.
  std::array<std::vector<double>, 3> rate_radps{};
};

struct WheelOptions {
  double gravity_mps2 = standard_gravity_mps2;
  /// Spin axis in the axes of each sensor, any length; found from the data where not given.
  std::optional<std::array<double, 3>> spin_axis;
  std::optional<double> radius_m;      ///< distance of each sensor from the axle, where known
  std::optional<double> radius_std_m;  ///< of that; not given: 2 %, at least 0.2 mm
  std::optional<double> rim_radius_m;  ///< of the circle whose path is the distance travelled
  /// Radius on which the wheel rolls, where it carries a vehicle and this is known, to 3 %; 0 for a
  /// bench. Its speeding up and braking then no longer lean on the angle. If not given, it is taken
  /// for 0.2 ± 0.12 m where the hub shakes, else for 0 ± 0.05 m.
  std::optional<double> rolling_radius_m;
  /// −3 dB bandwidth of the sensors' one-pole filter, which delays the measured gravity vector. If
  /// not given, the corner is taken to lie between 6 Hz (0.06 of the rate, where that is lower) and
  /// 2.5 times the rate.
  std::optional<double> bandwidth_hz;
  double axle_tilt_std_rad = 5.0 * std::numbers::pi / 180.0;  ///< of the axle from level
  /// One standard deviation of the angle between a sensor's axes and the marks of the wheel, which
  /// no accelerometer can see: part of the band of every angle, none of the number of turns.
  double alignment_std_rad = 0.0;
  bool clocks_shared = true;  ///< false: two sensors whose clocks have nothing in common
  Progress progress;
};

/// What one estimator says of the whole recording.
struct WheelMethod {
  std::optional<Uncertain> turns;  ///< std is 0 where the method gives none
  std::string note;                ///< why there is no figure, or what limits it
};

/// The sensor as found from the recording. Absent figures are explained in WheelSolution::notes.
struct WheelSensorFit {
  std::string name;
  std::array<double, 3> spin_axis{};  ///< unit vector in the sensor's axes
  bool spin_axis_given = false;
  std::optional<Uncertain> radius_m;      ///< from the axle to the sensor's proof mass
  std::optional<Uncertain> mounting_rad;  ///< sensor's first in-plane axis against the spoke
  /// Along the two in-plane axes, reading = scale · force + bias.
  std::array<std::optional<Uncertain>, 2> bias_mps2, scale;
  std::optional<Uncertain> skew_rad;        ///< by which the in-plane axes miss being square
  std::optional<Uncertain> phase_rad;       ///< second sensor against the first, about the axle
  std::optional<Uncertain> clock_offset_s;  ///< second sensor's clock against the first's
  bool has_gyro = false;                    ///< and the turns were counted with it
  /// Gyroscope about the axle: reading = scale · speed + bias.
  std::optional<Uncertain> gyro_scale, gyro_bias_radps;
  double noise_mps2 = 0.0;  ///< per sample and axis, at rest or at the quietest
  std::size_t samples = 0;
  std::size_t unusable = 0;  ///< rows dropped before the filter: not finite, or beyond belief
  std::size_t gated = 0;     ///< rows whose innovation passed the gate
};

/// One value for each instant of the merged time line; `angle` counts turns on, 0 = first in-plane
/// axis of the first sensor horizontal, positive about the spin axis.
struct WheelSeries {
  std::vector<double> time_s;
  std::vector<double> angle_rad, angle_std_rad;  ///< smoother: given all readings
  std::vector<double> speed_radps, speed_std_radps;
  std::vector<double> accel_radps2, accel_std_radps2;
  /// Given the readings so far, with the sensors calibrated by the whole recording.
  std::vector<double> filtered_angle_rad, filtered_angle_std_rad;
  std::vector<double> atan2_angle_rad;            ///< plain gravity phase, unwrapped
  std::vector<double> double_integral_angle_rad;  ///< empty where there is no radius
  std::vector<float> nis;                         ///< per instant, over its channels
  std::vector<unsigned char> channels_used;       ///< behind each nis; 0 = nothing used
  std::vector<unsigned char> channels_gated;
};

/// A stretch of time, for lists of what was rejected or lost.
struct Stretch {
  double start_s = 0.0, end_s = 0.0;
  std::size_t rows = 0;
  std::string reason;
};

/// A number of turns that the recording allows.
struct TurnsCandidate {
  Uncertain turns;
  double probability = 0.0;
};

struct WheelSolution {
  std::optional<Uncertain> turns;  ///< signed, about the spin axis of the first sensor
  /// Where the count is in doubt and `turns` is absent: the counts that fit, by falling
  /// probability.
  std::vector<TurnsCandidate> turns_candidates;
  std::optional<Uncertain> distance_m;  ///< path of the rim if given, else of the first sensor
  std::string distance_of;              ///< "rim" or the sensor's name
  std::optional<Uncertain> angle_final_rad;
  std::optional<Uncertain> peak_speed_radps;
  Uncertain delay_s{};  ///< of the sensors' filters, as given or as believed
  std::vector<WheelSensorFit> sensors;
  WheelMethod double_integration, atan2, ekf, smoother;
  Consistency consistency;
  std::size_t rejected_samples = 0;  ///< rows of any sensor that no estimate has seen
  std::vector<Stretch> rejected;     ///< the same, in stretches
  std::vector<std::string>
      not_observable;  ///< sentences: what this recording cannot tell, what would
  std::vector<Note> notes;
  WheelSeries series;
};

/// Angle, speed and acceleration of a wheel from one or two accelerometers anywhere on it, with the
/// sensors' biases, scales, radii and mounting angles as far as the recording shows them.
///
/// Errors: invalid_argument (no sensor, lengths that differ, an axis of length 0, time that does
/// not ascend), too_few_samples, not_observable (no spin axis can be found).
[[nodiscard]] Result<WheelSolution> estimate_wheel(const std::vector<WheelSensor>& sensors,
                                                   const WheelOptions& options);

}  // namespace proofmass::estimate
