#include "proofmass/estimate/wheel/baseline_methods.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_plain_test {
namespace {

using test::Drive;
using test::Mount;
using test::rpm;

/// Measurements of sensors whose x and y are u and v in the plane, all rows on one clock.
WheelReadings planar(const Drive& drive, const std::vector<Mount>& mounts, double rate_hz) {
  WheelReadings readings;
  for (const Mount& mount : mounts) {
    const WheelSensor sensor = test::record(drive, mount, rate_hz, 1);
    readings.time_s = sensor.time_s;
    readings.sensors.push_back({sensor.accel_mps2[0], sensor.accel_mps2[1],
                                std::vector<double>(sensor.time_s.size(), 1.0)});
  }
  for (std::size_t k = 0; k < readings.time_s.size(); ++k) {
    const auto row = static_cast<std::int64_t>(k);
    readings.epochs.push_back(
        {k == 0 ? 0.0 : 1.0 / rate_hz, {row, mounts.size() > 1 ? row : WheelEpoch::no_row}});
  }
  return readings;
}

Mount noise_free(std::complex<double> place_m, double turned_rad = 0.0) {
  Mount mount;
  mount.place_m = place_m;
  mount.turned_rad = turned_rad;
  mount.noise_mps2 = 0.0;
  return mount;
}

TEST(Atan2Angle, OnTheAxleIsTheAngleAndCountsTurnsEitherWay) {
  for (const double speed : {40 * rpm, -40 * rpm}) {
    const Drive drive{{0.3, speed}, {{6.0, speed}, {2.0, 0.0}}};
    const auto readings = planar(drive, {noise_free({0.0, 0.0})}, 100.0);
    const auto angle = atan2_angle(readings);
    ASSERT_EQ(angle.size(), readings.time_s.size());
    for (std::size_t k = 0; k < angle.size(); ++k)
      EXPECT_NEAR(angle[k], drive.at(readings.time_s[k]).angle_rad, 1e-9) << "k = " << k;
  }
}

TEST(Atan2Angle, OfAnOppositePairCancelsTheMotion) {
  const Drive drive{{0.0, 0.0}, {{2.0, 120 * rpm}, {2.0, -30 * rpm}}};
  for (const double turned : {0.0, test::pi}) {
    auto readings = planar(drive, {noise_free({0.1, 0.0}), noise_free({-0.1, 0.0}, turned)}, 200.0);
    readings.phase_rad = turned;
    const auto angle = atan2_angle(readings);
    for (std::size_t k = 0; k < angle.size(); ++k)
      EXPECT_NEAR(angle[k], drive.at(readings.time_s[k]).angle_rad, 1e-9) << "k = " << k;
  }
}

TEST(Atan2Angle, StopsCountingWhereTheCentripetalForceIsLargerThanGravity) {
  const Drive drive{{0.0, 300 * rpm}, {{5.0, 300 * rpm}}};
  const auto angle = atan2_angle(planar(drive, {noise_free({0.1, 0.0})}, 200.0));
  EXPECT_LT(std::abs(angle.back() - angle.front()), test::pi);  // of 25 turns
}

TEST(Atan2Angle, WaitsForTheFirstReadingAndKeepsTheLastThroughAGap) {
  const Drive drive{{0.2, 20 * rpm}, {{2.0, 20 * rpm}}};
  auto readings = planar(drive, {noise_free({0.0, 0.0})}, 100.0);
  for (const std::size_t k : {0U, 1U, 50U})
    readings.sensors[0].u_mps2[k] = std::numeric_limits<double>::quiet_NaN();
  const auto angle = atan2_angle(readings);
  EXPECT_TRUE(std::isnan(angle[1]));
  EXPECT_NEAR(angle[2], drive.at(0.02).angle_rad, 1e-9);
  EXPECT_EQ(angle[50], angle[49]);
  EXPECT_NEAR(angle[51], drive.at(0.51).angle_rad, 1e-9);
}

TEST(DoubleIntegral, OfANoiseFreeOppositePairGivesTheAngleBack) {
  const Drive drive{{0.4, 15 * rpm}, {{3.0, -40 * rpm}, {3.0, 60 * rpm}}};
  const auto readings = planar(drive, {noise_free({0.1, 0.0}), noise_free({-0.1, 0.0})}, 1000.0);
  const auto angle =
      double_integral_angle(readings, Eigen::Vector4d(0.1, 0.0, -0.1, 0.0), 0.4, 15 * rpm);
  ASSERT_EQ(angle.size(), readings.time_s.size());
  for (std::size_t k = 0; k < angle.size(); ++k)
    EXPECT_NEAR(angle[k], drive.at(readings.time_s[k]).angle_rad, 2e-5) << "k = " << k;
}

TEST(DoubleIntegral, OfABiasGrowsWithTheSquareOfTime) {
  Mount one = noise_free({0.1, 0.0}), two = noise_free({-0.1, 0.0});
  one.bias_mps2[1] = 0.01;
  two.bias_mps2[1] = -0.01;
  const Drive drive{{0.0, 0.0}, {{20.0, 0.0}}};
  const auto angle = double_integral_angle(planar(drive, {one, two}, 100.0),
                                           Eigen::Vector4d(0.1, 0.0, -0.1, 0.0), 0.0, 0.0);
  EXPECT_NEAR(angle.back(), 0.5 * (0.01 / 0.1) * 20.0 * 20.0, 1e-9);  // b t² / (2 R)
  EXPECT_NEAR(angle[1000], 0.25 * angle.back(), 1e-9);
}

TEST(DoubleIntegral, OfASensorOnTheAxleIsNone) {
  const Drive drive{{0.0, 0.0}, {{1.0, 0.0}}};
  EXPECT_TRUE(double_integral_angle(planar(drive, {noise_free({0.0, 0.0})}, 100.0),
                                    Eigen::Vector2d(0.0, 0.0), 0.0, 0.0)
                  .empty());
}

TEST(PlainPlaces, AreTheOnesFoundAndOppositeOnesWhereNoDirectionShows) {
  WheelSensorFit first, second;
  EXPECT_FALSE(plain_places({first}, 0.0).has_value());
  first.radius_m = second.radius_m = Uncertain{0.1, 0.002};
  const auto taken = plain_places({first, second}, 0.3);
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->taken);
  EXPECT_NEAR((taken->places_m.head<2>() - Eigen::Vector2d(0.1, 0.0)).norm(), 0.0, 1e-12);
  // On the opposite side of the axle, with axes rotated by 0.3.
  const Eigen::Vector2d other(-0.1 * std::cos(0.3), 0.1 * std::sin(0.3));
  EXPECT_NEAR((taken->places_m.tail<2>() - other).norm(), 0.0, 1e-12);
  first.mounting_rad = Uncertain{-0.5, 0.01};
  const auto found = plain_places({first}, 0.0);
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->taken);
  const Eigen::Vector2d ahead(0.1 * std::cos(0.5), 0.1 * std::sin(0.5));
  EXPECT_NEAR((found->places_m - ahead).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_plain_test
