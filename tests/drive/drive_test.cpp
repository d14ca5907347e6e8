// Properties of the estimate of a vehicle's path, by the simulator that shares no formula with it.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "vehicle_world.hpp"

namespace proofmass::drive_world::drive_test {
namespace {

Result<estimate::DriveSolution> solve(const World& world) {
  return estimate::estimate_drive(world.wheels, world.frame, world.fixes, world.options);
}

// Yaw rates, track width and the gyroscope's scale by a common factor give the same measurements:
// only the prior of the gyroscope's scale (1.5 %) determines the track width.
TEST(Drive, LeavesTheScaleOfTheYawRateToItsPrior) {
  Scenario scenario{.name = "encoder-frame"};
  scenario.gyroscopes = scenario.track_known = false;
  scenario.frame = scenario.encoders = true;
  scenario.slip_m_per_rtm = 0.0005;
  constexpr int recordings = 5;
  double sum = 0.0;
  for (std::uint64_t seed = 9201; seed < 9201 + recordings; ++seed) {
    const World world = make_world(scenario, seed);
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    ASSERT_TRUE(solved->track_m.has_value());
    EXPECT_NEAR(solved->track_m->std / world.truth.track_m, 0.015, 0.0005) << seed;
    sum += solved->track_m->value / world.truth.track_m - 1.0;
  }
  // The world's scale errors are 1 %.
  EXPECT_LT(std::abs(sum / recordings), 3.0 * 0.01 / std::sqrt(recordings));
}

// The likelihood of steered wheels exceeded that of unsteered ones by e³⁰, and the distance was a
// quarter of a per cent too small.
TEST(Drive, TakesTheWheelsOfOneAxleAsUnsteeredUnlessTheyMeasureIt) {
  Scenario scenario{.name = "encoder-stops"};
  scenario.gyroscopes = scenario.steered_known = false;
  scenario.frame = scenario.encoders = scenario.stops = true;
  for (std::uint64_t seed = 9301; seed < 9304; ++seed) {
    const World world = make_world(scenario, seed);
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    EXPECT_FALSE(solved->wheelbase_m) << seed;
    const double rolled_m =
        0.5 * (solved->wheels[0].turns->value * solved->wheels[0].circumference_m->value +
               solved->wheels[1].turns->value * solved->wheels[1].circumference_m->value);
    EXPECT_NEAR(solved->distance_m->value, rolled_m, 0.1) << seed;
  }
}

TEST(Drive, FindsTheSteeredAxleByTheWheelsOfTwoAxles) {
  Scenario scenario{.name = "encoder-steered"};
  scenario.gyroscopes = scenario.steered_known = false;
  scenario.frame = scenario.encoders = scenario.front_axle = true;
  const World world = make_world(scenario, 9311);
  const auto solved = solve(world);
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  for (const estimate::DriveWheelFit& wheel : solved->wheels)
    EXPECT_EQ(wheel.steered, wheel.name.starts_with("front")) << wheel.name;
}

// Speeds of the two sides change in opposite directions in turns: the offset that correlated best
// was up to a second off, with a standard deviation of 0.05 s.
TEST(Drive, RelatesTheClocksOfTwoSidesByTheirStartsAndStops) {
  Scenario scenario{.name = "encoder-sides"};
  scenario.gyroscopes = false;
  scenario.frame = scenario.encoders = scenario.own_clocks = true;
  scenario.steering = 3.0;
  for (std::uint64_t seed = 9321; seed < 9326; ++seed) {
    World world = make_world(scenario, seed);
    // The frame's clock is a third one.
    world.frame->clock = 2;
    for (double& t : world.frame->sensor.time_s) t += 100.0;
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    const Uncertain offset = *solved->wheels[1].clock_offset_s;
    EXPECT_NEAR(offset.value, world.truth.clock_offset_s[1], 0.05) << seed;
    ASSERT_TRUE(solved->frame_clock_offset_s.has_value()) << seed;
    EXPECT_NEAR(solved->frame_clock_offset_s->value, 100.0, 0.05) << seed;
  }
}

// With an open track width the first path took the distance for a tenth of what it was, and the
// filter, linearised about it, found another one far off.
TEST(Drive, ConvergesWithFixesAndNoDimensionKnown) {
  Scenario scenario{.name = "encoder-gnss-stops"};
  scenario.gyroscopes = scenario.steered_known = false;
  scenario.circumference_known = scenario.track_known = false;
  scenario.fixes = scenario.encoders = scenario.stops = true;
  for (std::uint64_t seed = 9331; seed < 9337; ++seed) {
    const World world = make_world(scenario, seed);
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    EXPECT_NEAR(solved->distance_m->value, world.truth.distance_m, 4.0 * solved->distance_m->std)
        << seed;
    EXPECT_LT(solved->distance_m->std, 0.02 * world.truth.distance_m) << seed;
  }
}

// Reflections that shift the fixes for six seconds by 25 m: the speed at either end misled the
// search for the offset of the clocks, and the first fixes that a filter accepts decide which it
// rejects.
TEST(Drive, FollowsNoFixesThatAreShiftedForSeconds) {
  Scenario scenario{.name = "encoder-reflections"};
  scenario.gyroscopes = scenario.circumference_known = false;
  scenario.frame = scenario.fixes = scenario.encoders = true;
  constexpr double shift_rad = 25.0 / 6.37e6;
  for (std::uint64_t seed = 9361; seed < 9365; ++seed) {
    World world = make_world(scenario, seed);
    auto& fixes = world.fixes->fixes;
    const double start_s = fixes.front().time_s, end_s = fixes.back().time_s;
    for (const double share : {0.1, 0.4}) {
      const double from_s = start_s + share * (end_s - start_s);
      for (estimate::GnssFix& fix : fixes)
        if (fix.time_s > from_s && fix.time_s < from_s + 6.0) fix.latitude_rad += shift_rad;
    }
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    ASSERT_TRUE(solved->heading_start_rad.has_value()) << seed;
    const Uncertain heading = *solved->heading_change_rad, distance = *solved->distance_m;
    EXPECT_NEAR(heading.value, world.truth.heading_change_rad, 3.5 * heading.std) << seed;
    EXPECT_NEAR(distance.value, world.truth.distance_m, 3.5 * distance.std) << seed;
    EXPECT_LT(std::abs(std::remainder(
                  solved->heading_start_rad->value - world.truth.heading_start_rad, rad_per_turn)),
              3.5 * solved->heading_start_rad->std)
        << seed;
  }
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Without the rows in which the axis along the axle was saturated, the heading was up to 190
// standard deviations off: those in the plane of the wheel measure the yaw, and do so in all rows.
TEST(Drive, NeedsNoRateAlongTheAxle) {
  Scenario scenario{.name = "saturated"};
  scenario.duration_s = 40.0;
  for (std::uint64_t seed = 9341; seed < 9343; ++seed) {
    World world = make_world(scenario, seed);
    const auto whole = solve(world);
    ASSERT_TRUE(whole.has_value()) << whole.error().message;
    for (estimate::DriveWheel& wheel : world.wheels) {
      auto& spin = *std::ranges::max_element(wheel.sensor.rate_radps, {}, largest);
      auto& radial = wheel.sensor.accel_mps2[0];
      const double limit = 0.6 * largest(spin), limit_mps2 = 0.8 * largest(radial);
      for (double& rate : spin)
        if (std::abs(rate) > limit) rate = std::nan("");
      for (double& accel : radial)
        if (std::abs(accel) > limit_mps2) accel = std::nan("");
    }
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    const Uncertain heading = *solved->heading_change_rad;
    EXPECT_NEAR(heading.value, world.truth.heading_change_rad, 3.0 * heading.std) << seed;
    EXPECT_LT(heading.std, 1.2 * whole->heading_change_rad->std) << seed;
  }
}

TEST(Drive, WidensTheHeadingWhereTheFramesRatesAreMissing) {
  Scenario scenario{.name = "encoder-gap"};
  scenario.gyroscopes = scenario.track_known = false;
  scenario.frame = scenario.encoders = true;
  for (std::uint64_t seed = 9351; seed < 9354; ++seed) {
    World world = make_world(scenario, seed);
    const auto whole = solve(world);
    ASSERT_TRUE(whole.has_value()) << whole.error().message;
    estimate::WheelSensor& frame = world.frame->sensor;
    const double middle_s = 0.5 * (frame.time_s.front() + frame.time_s.back());
    for (auto& axis : frame.rate_radps)
      for (std::size_t k = 0; k < axis.size(); ++k)
        if (std::abs(frame.time_s[k] - middle_s) < 2.0) axis[k] = std::nan("");
    const auto solved = solve(world);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    const Uncertain heading = *solved->heading_change_rad;
    EXPECT_NEAR(heading.value, world.truth.heading_change_rad, 3.0 * heading.std) << seed;
    EXPECT_GE(heading.std, whole->heading_change_rad->std) << seed;
  }
}

}  // namespace
}  // namespace proofmass::drive_world::drive_test
