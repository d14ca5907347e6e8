#include "proofmass/thesis/motor_items.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numbers>
#include <string_view>

namespace proofmass::thesis::motor_items_test {
namespace {

const Finding& finding(const Item& item, std::string_view key) {
  const auto found = std::ranges::find(item.findings, key, &Finding::key);
  EXPECT_NE(found, item.findings.end()) << key;
  return *found;
}

const Item& section() {
  static const Item item = motor_items().front();
  return item;
}

double ours(std::string_view key) {
  return finding(section(), key).ours.value().value;
}

TEST(MotorItems, TheConversionsThatTheThesisPrintsAreRightToTheirLastDigit) {
  EXPECT_NEAR(ours("perimeter"), *finding(section(), "perimeter").thesis, 5e-4);
  EXPECT_NEAR(ours("degrees_in_a_radian"), 57.29578, 5e-6);
  EXPECT_NEAR(ours("rpm_in_a_radian_per_second"), 9.55, 5e-3);
  EXPECT_NEAR(ours("turns_in_a_radian"), 0.159, 5e-4);
}

TEST(MotorItems, TheSpeedOfTheRimIsItsRadiusTimesTheAngularVelocity) {
  EXPECT_NEAR(ours("angular_velocity"), 2.0 * std::numbers::pi * 11.0 / 60.0, 1e-12);
  EXPECT_NEAR(ours("rim_speed"), 0.15 * ours("angular_velocity"), 1e-12);
  EXPECT_NEAR(ours("rim_speed"), *finding(section(), "rim_speed").thesis, 3e-4);
}

TEST(MotorItems, PowerIsForceTimesSpeedAtTheRimToo) {
  EXPECT_NEAR(ours("power"), 0.32 / 0.15 * ours("rim_speed"), 1e-12);
  EXPECT_NEAR(*finding(section(), "power").thesis, 0.32 * 0.066,
              5e-5);  // as the thesis computes it
}

// 1 hp is 5252 lbf ft times rpm: 220 in·lb at 31 rpm are 0.1082 hp, of an input of 1/8 hp.
TEST(MotorItems, ThePlateOfTheMotorKeepsTheBooksOfItsPower) {
  EXPECT_NEAR(ours("rated_power"), 220.0 / 12.0 * 31.0 / 5252.113 * 745.69987, 1e-3);
  EXPECT_LT(ours("rated_power"), *finding(section(), "input_power").thesis);
  EXPECT_LT(*finding(section(), "input_power").thesis, ours("input_power"));
}

TEST(MotorItems, WhatIsNotStatedIsAbsentWithItsReason) {
  for (const Finding& f : section().findings)
    EXPECT_EQ(f.reason.empty(), f.ours.has_value()) << f.key;
  EXPECT_FALSE(finding(section(), "torque").ours.has_value());
}

}  // namespace
}  // namespace proofmass::thesis::motor_items_test
