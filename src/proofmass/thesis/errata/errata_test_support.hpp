#pragma once

#include <string_view>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/simulate/rig.hpp"

// Shared by the tests of docs/errata.md: the thesis's wheel with a horizontal axle, and sensors
// with neither errors nor delay.
namespace proofmass::thesis::errata {

inline constexpr double g = standard_gravity_mps2;
inline constexpr double mg = 1e-3 * g;
inline constexpr double radius_m = 0.1;  ///< section 3.1.2
inline constexpr double rpm_11 = 11.0 * radps_per_rpm;

/// Constant speed without ripple from `start_angle_rad` on; two opposite sensors with parallel
/// axes.
inline simulate::RigOptions wheel(double speed_radps, double start_angle_rad = 0.0) {
  simulate::RigOptions options;
  options.bias_spread_mps2 = 0.0;
  options.wheel.start_angle_rad = start_angle_rad;
  options.wheel.profile = {{.duration_s = 6.0, .speed_radps = speed_radps}};
  options.wheel.ripple = {};
  options.wheel.axle_tilt_rad = 0.0;
  for (simulate::RigSensor& sensor : options.sensors) {
    sensor.filter_signal = false;
    sensor.warm_up_mps2 = {};
    sensor.noise_rms_mps2 = {};
  }
  return options;
}

inline std::vector<double> column(const Recording& recording, std::string_view name) {
  return recording.find(name)->values.copy();
}

/// The first measurement of one channel.
inline double first(const simulate::RigOptions& options, std::string_view name) {
  return column(simulate::simulate_rig(options).value().recording, name).front();
}

}  // namespace proofmass::thesis::errata
