#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/estimate/wheel.hpp"

// A second simulator of wheels, independent of simulate/ and without any formula of estimate/: a
// rigid body in inertial coordinates, stepped at 10 kHz. Acceleration is the second difference of
// the sensor's position; the speed is integrated from its differential equation; the sensor's
// filter is stepped. Effects unknown to the estimator: speed ripple depending on the angle, sensor
// delay, a tilted axle, a road, pushes by hand, Wi-Fi stamps.
namespace proofmass::wheel_world {

/// Shape of the commanded speed; stop_and_go is start_stop once a minute.
enum class Course { constant, two_speeds, ramp, start_stop, stop_and_go, reversal, wander, pushes };

struct Gyro {
  double scale = 1.0, bias_radps = 0.0, noise_radps = 0.003;
};

/// An encoder on the axle, read with the first unit's rows: the head sees the angle about the
/// centre of a disc that is off the axle and warped.
struct Encoder {
  int counts_per_turn = 4096;
  bool reversed = false;
  double eccentricity = 0.0, eccentricity_phase = 0.0;  ///< of the disc's radius
  double warp_rad = 0.0, warp_phase = 0.0;
};

/// Time before the first row, for the filters to settle.
inline constexpr double lead_s = 0.05;

/// One sensor, in its own axes: u and v in the plane of the wheel, then the axle.
struct Unit {
  double radius_m = 0.1, direction_rad = 0.0;  ///< its position, in the wheel's axes
  double mounting_rad = 0.0;                   ///< its u axis relative to the wheel's first axis
  std::array<double, 3> bias_mps2{};
  std::array<double, 2> scale{1.0, 1.0};
  double skew_rad = 0.0;
  double noise_mps2 = 0.03, step_mps2 = 0.0;  ///< quantisation step; 0: none
  double walk_mps2_rts = 0.0;
  double warm_up_mps2 = 0.0;
  double pole_hz = 0.0;  ///< of the sensor's filter; 0: none
  std::optional<Gyro> gyro;
};

struct World {
  Course course = Course::constant;
  double duration_s = 40.0, rate_hz = 200.0;
  double slow_radps = 5.0, fast_radps = 10.0;
  double start_angle_rad = 0.0;  ///< lead_s before the first row
  double ripple = 0.0;           ///< fraction of the speed, at 1, 2 and 7 per turn each
  double axle_tilt_rad = 0.0;
  double rolling_radius_m = 0.0;
  double road_mps2 = 0.0;  ///< rms vibration of the hub, with resonances at 1.5, 12, 60 Hz
  double jitter = 0.0, missing = 0.0;  ///< relative to the period; fraction of rows
  bool stamps_by_wifi = false;         ///< rows arrive in bursts and are stamped on arrival
  std::vector<Unit> units;
  std::optional<Encoder> encoder;
};

/// True values of a recording.
struct Truth {
  double turns = 0.0, final_angle_rad = 0.0, rolling_radius_m = 0.0;
  /// Angle of the first unit's u axis at the times of all rows, including missing ones.
  std::vector<double> time_s, angle_rad;
  std::vector<Unit> units;
  /// Biases at the end, including random walk and warm-up.
  std::vector<std::array<double, 2>> final_bias_mps2;
  std::array<double, 4> encoder_errors_rad{};  ///< c1 s1 c2 s2, to second order
};

struct Recorded {
  std::vector<estimate::WheelSensor> sensors;
  std::optional<estimate::WheelEncoder> encoder;
  Truth truth;
};

[[nodiscard]] Recorded record(const World& world, std::uint64_t seed);

/// A randomly drawn kind of recording.
struct Scenario {
  const char* name;
  const char* what;  ///< for the table
  World (*draw)(std::uint64_t seed);
  /// Options as given by a user.
  estimate::WheelOptions (*options)(const World& world);
};

[[nodiscard]] std::span<const Scenario> scenarios();

}  // namespace proofmass::wheel_world
