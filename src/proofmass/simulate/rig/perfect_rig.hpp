#pragma once

#include <gtest/gtest.h>
#include <string_view>
#include <vector>

#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig/bench_test_support.hpp"

// Shared by the tests of the rig.
namespace proofmass::simulate {

inline constexpr double g = standard_gravity_mps2;

/// The thesis's wheel with a level axle and sensors without errors or delay.
inline RigOptions perfect() {
  RigOptions options;
  options.bias_spread_mps2 = 0.0;
  options.wheel.profile = {{.duration_s = 4.0, .speed_radps = 11.0 * radps_per_rpm},
                           {.duration_s = 4.0, .speed_radps = -21.0 * radps_per_rpm, .ramp_s = 2.0},
                           {.duration_s = 2.0, .speed_radps = 0.0, .ramp_s = 0.5}};
  options.wheel.axle_tilt_rad = 0.0;
  for (RigSensor& sensor : options.sensors) {
    sensor.filter_signal = false;
    sensor.warm_up_mps2 = {};
    sensor.noise_rms_mps2 = {};
  }
  return options;
}

inline RigResult simulated(const RigOptions& options) {
  return simulate_rig(options).value();
}

}  // namespace proofmass::simulate
