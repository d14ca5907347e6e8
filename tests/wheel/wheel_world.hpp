#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/estimate/wheel.hpp"

// A second simulator of wheels, written another way than simulate/ and sharing no formula with
// estimate/: a rigid body in inertial coordinates, stepped at 10 kHz. Acceleration is the second
// difference of the sensor's position; the speed is integrated from its differential equation; the
// sensor's filter is stepped along. What it knows and the estimator does not: a speed that ripples
// with the angle, a sensor that delays, a tilted axle, a road, pushes by hand, stamps of Wi-Fi.
namespace proofmass::wheel_world {

/// How the commanded speed goes.
enum class Course { constant, two_speeds, ramp, start_stop, reversal, wander, pushes };

struct Gyro {
  double scale = 1.0, bias_radps = 0.0, noise_radps = 0.003;
};

/// Before the first row, for the filters to settle.
inline constexpr double lead_s = 0.05;

/// One sensor, in its own axes: u and v in the plane of the wheel, then the axle.
struct Unit {
  double radius_m = 0.1, direction_rad = 0.0;  ///< its place, in the wheel's axes
  double mounting_rad = 0.0;                   ///< its u against the wheel's first axis
  std::array<double, 3> bias_mps2{};
  std::array<double, 2> scale{1.0, 1.0};
  double skew_rad = 0.0;
  double noise_mps2 = 0.03, step_mps2 = 0.0;  ///< of the converter; 0: none
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
  double ripple = 0.0;           ///< share of the speed, at 1, 2 and 7 a turn each
  double axle_tilt_rad = 0.0;
  double rolling_radius_m = 0.0;
  double road_mps2 = 0.0;  ///< rms of the hub's shaking, with resonances at 1.5, 12, 60 Hz
  double jitter = 0.0, missing = 0.0;  ///< of a step; share of rows
  bool stamps_by_wifi = false;         ///< rows come in bursts and are stamped then
  std::vector<Unit> units;
};

/// What is true of a recording.
struct Truth {
  double turns = 0.0, final_angle_rad = 0.0;
  /// Of the first unit's u, at the times of all rows, those that are missing among them.
  std::vector<double> time_s, angle_rad;
  std::vector<Unit> units;
  /// Biases at the last instant, walk and warm-up in them.
  std::vector<std::array<double, 2>> final_bias_mps2;
};

struct Recorded {
  std::vector<estimate::WheelSensor> sensors;
  Truth truth;
};

[[nodiscard]] Recorded record(const World& world, std::uint64_t seed);

/// A kind of recording, drawn at random.
struct Scenario {
  const char* name;
  const char* what;  ///< for the table
  World (*draw)(std::uint64_t seed);
  /// Options as a user would give them.
  estimate::WheelOptions (*options)(const World& world);
};

[[nodiscard]] std::span<const Scenario> scenarios();

}  // namespace proofmass::wheel_world
