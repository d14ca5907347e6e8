#include "proofmass/simulate/wheel_motion.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::simulate::wheel_motion_test {
namespace {

const SpeedRipple no_ripple{};
const SpeedRipple every_ripple{
    .fraction = 0.04, .order = 3.0, .random_fraction_rms = 0.02, .random_max_order = 8.0};
/// Rest, start, run, step, reversal, stop.
const std::vector<SpeedSegment> profile{{.duration_s = 2.0},
                                        {.duration_s = 5.0, .speed_radps = 2.0, .ramp_s = 1.0},
                                        {.duration_s = 3.0, .speed_radps = 3.0},
                                        {.duration_s = 4.0, .speed_radps = -1.0, .ramp_s = 2.0},
                                        {.duration_s = 1.0, .speed_radps = 0.0, .ramp_s = 0.5}};

TEST(WheelMotion, At11RpmTurnsElevenTimesAMinute) {
  const WheelMotion motion(0.5, {{.duration_s = 60.0, .speed_radps = 11.0 * radps_per_rpm}},
                           no_ripple, 1);
  EXPECT_NEAR(motion.at(60.0).angle_rad, 0.5 + 11.0 * rad_per_turn, 1e-12);
  EXPECT_EQ(motion.at(30.0).accel_radps2, 0.0);
  EXPECT_EQ(motion.duration_s(), 60.0);
}

TEST(WheelMotion, FollowsItsProfile) {
  const WheelMotion motion(0.0, profile, no_ripple, 1);
  EXPECT_DOUBLE_EQ(motion.duration_s(), 15.0);
  EXPECT_EQ(motion.at(1.9).angle_rad, 0.0);
  EXPECT_DOUBLE_EQ(motion.at(2.5).speed_radps, 1.0);
  EXPECT_DOUBLE_EQ(motion.at(2.5).accel_radps2, 2.0);
  EXPECT_DOUBLE_EQ(motion.at(7.0).angle_rad, 1.0 + 8.0);
  EXPECT_DOUBLE_EQ(motion.at(7.0).speed_radps, 3.0);
  EXPECT_DOUBLE_EQ(motion.at(10.0).angle_rad, 18.0);
  EXPECT_DOUBLE_EQ(motion.at(11.5).speed_radps, 0.0);
  EXPECT_DOUBLE_EQ(motion.at(14.0).angle_rad, 18.0 + 2.0 - 2.0);
  EXPECT_DOUBLE_EQ(motion.at(15.0).angle_rad, 18.0 - 0.25);
  EXPECT_EQ(motion.at(14.8).speed_radps, 0.0);
}

TEST(WheelMotion, FirstStretchStartsAtRestIfItHasARamp) {
  const WheelMotion motion(0.0, {{.duration_s = 2.0, .speed_radps = 4.0, .ramp_s = 2.0}}, no_ripple,
                           1);
  EXPECT_EQ(motion.at(0.0).speed_radps, 0.0);
  EXPECT_DOUBLE_EQ(motion.at(2.0).angle_rad, 4.0);
}

// Second computation: five-point differences of the angle, and of the speed.
TEST(WheelMotion, SpeedAndAccelerationAreTheDerivativesOfTheAngle) {
  const WheelMotion motion(0.3, profile, every_ripple, 5);
  constexpr double h = 1e-3;
  const auto slope = [&](double t, auto what) {
    return (8.0 * (what(t + h) - what(t - h)) - (what(t + 2 * h) - what(t - 2 * h))) / (12.0 * h);
  };
  for (double t = 0.05; t < 15.0; t += 0.1) {
    EXPECT_NEAR(motion.at(t).speed_radps,
                slope(t, [&](double s) { return motion.at(s).angle_rad; }), 1e-8)
        << t;
    EXPECT_NEAR(motion.at(t).accel_radps2,
                slope(t, [&](double s) { return motion.at(s).speed_radps; }), 1e-7)
        << t;
  }
}

// Second computation: Simpson's rule over the speed.
TEST(WheelMotion, AngleIsTheIntegralOfTheSpeedToANanoradian) {
  const WheelMotion motion(0.3, {{.duration_s = 60.0, .speed_radps = 11.0 * radps_per_rpm}},
                           every_ripple, 5);
  constexpr int steps = 24000;
  constexpr double h = 60.0 / steps;
  double sum = motion.at(0.0).speed_radps + motion.at(60.0).speed_radps;
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * motion.at(i * h).speed_radps;
  EXPECT_NEAR(motion.at(60.0).angle_rad, 0.3 + sum * h / 3.0, 1e-9);
}

TEST(WheelMotion, RippleHasItsRmsAndRepeatsWithTheTurns) {
  const double speed = 2.0;
  const WheelMotion motion(0.0, {{.duration_s = 600.0, .speed_radps = speed}},
                           {.fraction = 0.02 * std::numbers::sqrt2, .order = 1.0}, 9);
  Moments seen;
  const double turn_s = rad_per_turn / speed;
  for (int k = 0; k < 1000; ++k) seen.add(motion.at(k * turn_s / 1000).speed_radps / speed - 1.0);
  EXPECT_NEAR(seen.mean, 0.0, 1e-12);
  EXPECT_NEAR(seen.std(), 0.02, 2e-5);
  EXPECT_NEAR(motion.at(1.0 + 7 * turn_s).angle_rad, motion.at(1.0).angle_rad + 7 * rad_per_turn,
              1e-12);

  const WheelMotion random(0.0, {{.duration_s = 2000.0, .speed_radps = speed}},
                           {.random_fraction_rms = 0.05, .random_max_order = 4.0}, 9);
  Moments noise;
  for (int k = 0; k < 100000; ++k) noise.add(random.at(k * 0.02).speed_radps / speed - 1.0);
  EXPECT_NEAR(noise.std(), 0.05, 0.002);
}

TEST(WheelMotion, AtRestDoesNotRipple) {
  const WheelMotion motion(0.7, {{.duration_s = 10.0}}, every_ripple, 5);
  EXPECT_EQ(motion.at(4.0).angle_rad, 0.7);
  EXPECT_EQ(motion.at(4.0).speed_radps, 0.0);
  EXPECT_EQ(motion.at(4.0).accel_radps2, 0.0);
}

}  // namespace
}  // namespace proofmass::simulate::wheel_motion_test
