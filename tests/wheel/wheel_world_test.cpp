// Comparison of the two simulators of wheels: closed forms in the wheel's axes, and a body stepped
// in inertial coordinates.
#include "wheel_world.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/simulate/rig.hpp"

namespace proofmass::wheel_world_test {
namespace {

using wheel_world::Unit;
using wheel_world::World;

/// An ideal sensor at 80 mm on a wheel of constant speed.
World bare_world() {
  World world;
  world.duration_s = 4.0;
  world.rate_hz = 200.0;
  world.slow_radps = 11.0;
  world.start_angle_rad = 0.4;
  Unit unit;
  unit.radius_m = 0.08;
  unit.direction_rad = 0.9;
  unit.mounting_rad = 2.1;
  unit.noise_mps2 = 0.0;
  world.units.push_back(unit);
  return world;
}

simulate::RigOptions bare_rig(const World& world) {
  const Unit& unit = world.units.front();
  simulate::RigOptions rig;
  rig.rate_hz = world.rate_hz;
  rig.bias_spread_mps2 = 0.0;
  rig.wheel.start_angle_rad = world.start_angle_rad + wheel_world::lead_s * world.slow_radps;
  rig.wheel.profile = {{.duration_s = world.duration_s, .speed_radps = world.slow_radps}};
  rig.wheel.ripple = {};
  rig.wheel.axle_tilt_rad = world.axle_tilt_rad;
  simulate::RigSensor sensor;
  sensor.radius_m = unit.radius_m;
  sensor.position_rad = unit.direction_rad;
  sensor.mounting_rad = unit.mounting_rad;
  sensor.warm_up_mps2 = {};
  sensor.noise_rms_mps2 = {};
  sensor.filter_signal = unit.pole_hz > 0.0;
  sensor.bandwidth_hz = unit.pole_hz;
  sensor.full_scale_mps2 = 100.0;
  rig.sensors = {sensor};
  return rig;
}

/// Largest difference of a channel from row `from` on, m/s².
double largest_difference(const World& world, std::size_t from) {
  simulate::RigOptions options = bare_rig(world);
  if (!options.sensors.front().filter_signal) options.sensors.front().bandwidth_hz = 100.0;
  const auto rig = simulate::simulate_rig(options).value();
  const auto recorded = wheel_world::record(world, 1);
  double most = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& other = rig.recording.channels[axis].values;
    const auto& own = recorded.sensors.front().accel_mps2[axis];
    for (std::size_t k = from; k < std::min(own.size(), other.size()); ++k)
      most = std::max(most, std::abs(own[k] - other[k]));
  }
  return most;
}

TEST(WheelWorld, ReadsWhatTheRigReads) {
  EXPECT_LT(largest_difference(bare_world(), 0), 1e-4);
}

TEST(WheelWorld, ReadsWhatTheRigReadsOnATiltedAxle) {
  World world = bare_world();
  world.axle_tilt_rad = 0.15;
  EXPECT_LT(largest_difference(world, 0), 1e-4);
}

// Two discretisations of one pole, after settling.
TEST(WheelWorld, DelaysAsTheRigDelays) {
  World world = bare_world();
  world.units.front().pole_hz = 30.0;
  EXPECT_LT(largest_difference(world, 40), 0.01);
  EXPECT_GT(largest_difference(bare_world(), 0), 0.0);
}

TEST(WheelWorld, CountsTheTurnsOfItsSpeed) {
  const auto recorded = wheel_world::record(bare_world(), 1);
  EXPECT_NEAR(recorded.truth.turns, 11.0 * 4.0 / rad_per_turn, 1e-9);
}

}  // namespace
}  // namespace proofmass::wheel_world_test
