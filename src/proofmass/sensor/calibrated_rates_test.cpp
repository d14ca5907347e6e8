#include "proofmass/sensor/calibrated_rates.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::sensor::calibrated_rates_test {
namespace {

using Triple = std::array<std::vector<double>, 3>;

Gyroscope calibrated() {
  Gyroscope gyroscope;
  gyroscope.bias = make_axis_figures({0.1, -0.2, 0.3}, "rad/s", "test");
  gyroscope.scale = make_axis_figures({1.25, 0.8, 1.0}, "1", "test");
  return gyroscope;
}

TEST(CalibratedRates, SubtractBiasAndDivideByScale) {
  Triple rates{{{1.35}, {0.6}, {0.3}}};
  ASSERT_TRUE(apply(calibrated(), {}, rates));
  EXPECT_NEAR(rates[0][0], 1.0, 1e-12);
  EXPECT_NEAR(rates[1][0], 1.0, 1e-12);
  EXPECT_NEAR(rates[2][0], 0.0, 1e-12);
}

// A quarter turn about z takes the gyroscope's x axis to the accelerometer's y axis.
TEST(CalibratedRates, RotateIntoTheAccelerometersFrame) {
  Gyroscope gyroscope;
  gyroscope.scale = make_axis_figures({1.0, 1.0, 1.0}, "1", "test");
  gyroscope.alignment = make_axis_figures({0.0, 0.0, 0.5 * 3.14159265358979}, "rad", "test");
  Triple rates{{{2.0}, {0.0}, {0.5}}};
  ASSERT_TRUE(apply(gyroscope, {}, rates));
  EXPECT_NEAR(rates[0][0], 0.0, 1e-12);
  EXPECT_NEAR(rates[1][0], 2.0, 1e-12);
  EXPECT_NEAR(rates[2][0], 0.5, 1e-12);
}

TEST(CalibratedRates, MisalignmentMixesTheAxesAsInTheModel) {
  Gyroscope gyroscope = calibrated();
  gyroscope.misalignment = make_axis_figures({0.01, 0.02, 0.03}, "rad", "test");
  Triple rates{{{0.1}, {-0.2 + 0.8}, {0.3 + 2.0}}};  // (0, 1, 2) after bias and scale
  ASSERT_TRUE(apply(gyroscope, {}, rates));
  EXPECT_NEAR(rates[0][0], -0.01 * 1.0 + 0.02 * 2.0, 1e-12);
  EXPECT_NEAR(rates[1][0], 1.0 - 0.03 * 2.0, 1e-12);
}

TEST(CalibratedRates, RemoveTheEffectOfGravity) {
  Gyroscope gyroscope = calibrated();
  gyroscope.g_sensitivity[0] = make_axis_figures({0.0, 0.0, 0.01}, "rad/s/(m/s^2)", "test");
  const double none = std::numeric_limits<double>::quiet_NaN();
  Triple rates{{{0.1 + 0.0981, 0.1}, {-0.2, -0.2}, {0.3, 0.3}}};
  ASSERT_TRUE(apply(gyroscope, {{{0.0, 0.0}, {0.0, 0.0}, {9.81, none}}}, rates));
  EXPECT_NEAR(rates[0][0], 0.0, 1e-12);
  EXPECT_NEAR(rates[0][1], 0.0, 1e-12);
}

TEST(CalibratedRates, KnowTheirUnit) {
  EXPECT_EQ(reading_unit(calibrated()), "rad/s");
  EXPECT_TRUE(is_calibrated(calibrated()));
  EXPECT_FALSE(is_calibrated({}));
  Gyroscope counts;
  counts.scale = make_axis_figures({4800.0, 4800.0, 4800.0}, "counts/(rad/s)", "test");
  EXPECT_EQ(reading_unit(counts), "counts");
}

TEST(CalibratedRates, RefuseAScaleOfZeroAndUnequalLengths) {
  Gyroscope gyroscope = calibrated();
  gyroscope.scale[1]->value = 0.0;
  Triple rates{{{1.0}, {1.0}, {1.0}}};
  EXPECT_FALSE(apply(gyroscope, {}, rates));
  rates[2].push_back(1.0);
  EXPECT_FALSE(apply(calibrated(), {}, rates));
}

}  // namespace
}  // namespace proofmass::sensor::calibrated_rates_test
