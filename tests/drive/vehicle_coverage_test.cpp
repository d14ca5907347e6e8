// The 95 % intervals of a vehicle's path contain the truth about 95 times in a hundred, or more.
#include "vehicle_coverage.hpp"

#include <gtest/gtest.h>

namespace proofmass::drive_world::vehicle_coverage_test {
namespace {

class Coverages : public testing::TestWithParam<Scenario> {};

TEST_P(Coverages, HoldForEveryQuantity) {
  // A wheel with an accelerometer takes seconds, an encoder none.
  const std::size_t count = GetParam().encoders ? 30 : 3;
  const Covered covered = cover(GetParam(), 9001, count);
  EXPECT_LE(covered.refused, count / 20);
  for (const auto& [name, coverage] : covered.table) {
    if (coverage.recordings == 0) continue;
    EXPECT_LT(coverage.largest, 5.0) << name;
    // Below 24 of 30 an interval that holds 95 % of the time has a probability of 0.3 %.
    if (coverage.recordings >= 24) {
      EXPECT_GE(coverage.percent(), 80.0) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Vehicle, Coverages, testing::ValuesIn(scenarios()), [](const auto& of) {
  std::string name = of.param.name;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
});

TEST(OneSideWithoutGyroscope, LeavesTheHeadingOpenAndSaysSo) {
  Scenario scenario{.name = "right-accel"};
  scenario.gyroscopes = scenario.left = scenario.track_known = false;
  const World world = make_world(scenario, 17);
  const auto solved =
      estimate::estimate_drive(world.wheels, world.frame, world.fixes, world.options);
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  EXPECT_FALSE(solved->heading_change_rad);
  EXPECT_FALSE(solved->end_m[0]);
  ASSERT_FALSE(solved->not_observable.empty());
  EXPECT_NE(solved->not_observable.front().find("do not show turns"), std::string::npos);
}

TEST(AccelerometersWithoutScale, LeaveTheDistanceOpenAndSayWhatDeterminesIt) {
  Scenario scenario{.name = "no-scale"};
  scenario.circumference_known = false;
  const World world = make_world(scenario, 18);
  const auto solved =
      estimate::estimate_drive(world.wheels, world.frame, world.fixes, world.options);
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  EXPECT_FALSE(solved->distance_m);
  EXPECT_TRUE(solved->heading_change_rad);
  EXPECT_NE(solved->not_observable.front().find("circumference"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::drive_world::vehicle_coverage_test
