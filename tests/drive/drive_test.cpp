// Properties of the estimate of a vehicle's path, by the simulator that shares no formula with it.
#include <cmath>
#include <gtest/gtest.h>

#include "vehicle_world.hpp"

namespace proofmass::drive_world::drive_test {
namespace {

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
    const auto solved =
        estimate::estimate_drive(world.wheels, world.frame, world.fixes, world.options);
    ASSERT_TRUE(solved.has_value()) << solved.error().message;
    ASSERT_TRUE(solved->track_m.has_value());
    EXPECT_NEAR(solved->track_m->std / world.truth.track_m, 0.015, 0.0005) << seed;
    sum += solved->track_m->value / world.truth.track_m - 1.0;
  }
  // The world's scale errors are 1 %.
  EXPECT_LT(std::abs(sum / recordings), 3.0 * 0.01 / std::sqrt(recordings));
}

}  // namespace
}  // namespace proofmass::drive_world::drive_test
