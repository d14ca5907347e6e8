#include "proofmass/calibrate/cross_axis.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate::cross_axis_test {
namespace {

Eigen::Matrix2d diagonal(double a, double b) {
  Eigen::Matrix2d C = Eigen::Matrix2d::Zero();
  C(0, 0) = a;
  C(1, 1) = b;
  return C;
}

TEST(CrossAxis, IsTheLengthOfTheTwoRatios) {
  const CrossAxis found = cross_axis_sensitivity({0.003, 0.004}, diagonal(0, 0)).value();
  EXPECT_DOUBLE_EQ(found.value.value().value, 0.005);
  EXPECT_EQ(found.value->std, 0.0);
  EXPECT_EQ(found.upper_95, 0.005);
}

TEST(CrossAxis, IsAbsentIfNotDistinguishableFromZero) {
  const CrossAxis found = cross_axis_sensitivity({1e-3, 0.5e-3}, diagonal(1e-6, 1e-6)).value();
  EXPECT_FALSE(found.value);
  EXPECT_GT(found.p, 0.01);
  EXPECT_NE(found.reason.find("not distinguishable from zero"), std::string::npos);
  EXPECT_GT(found.upper_95, 1.1e-3);
}

// At zero the upper bound is the quantile of a Rayleigh distribution, σ √(−2 ln 0.05).
TEST(CrossAxis, HasTheBoundOfRayleighAtZero) {
  const CrossAxis found = cross_axis_sensitivity({0, 0}, diagonal(4e-6, 4e-6)).value();
  EXPECT_NEAR(found.upper_95, 2e-3 * std::sqrt(-2.0 * std::log(0.05)), 1e-8);
  EXPECT_EQ(found.p, 1.0);
}

// If one ratio is exact, it is the bound of a half-normal distribution.
TEST(CrossAxis, HasTheBoundOfTheHalfNormalWhereOneRatioIsExact) {
  const CrossAxis found = cross_axis_sensitivity({0, 0}, diagonal(1e-6, 0)).value();
  EXPECT_NEAR(found.upper_95, 1.959964e-3, 2e-8);
}

TEST(CrossAxis, DoesNotDependOnHowTheTwoDirectionsAreTurned) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  Eigen::Matrix2d R;
  R << c, -s, s, c;
  const Eigen::Vector2d r(0.004, 0.001);
  const Eigen::Matrix2d C = diagonal(1e-6, 4e-7);
  const CrossAxis one = cross_axis_sensitivity(r, C).value();
  const CrossAxis other = cross_axis_sensitivity(R * r, R * C * R.transpose()).value();
  EXPECT_NEAR(one.value.value().value, other.value.value().value, 1e-15);
  EXPECT_NEAR(one.value->std, other.value->std, 1e-15);
  EXPECT_NEAR(one.upper_95, other.upper_95, 1e-9);
}

struct Coverage {
  double upper, interval, bias_in_std;
};

Coverage repeat(const Eigen::Vector2d& truth, const Eigen::Vector2d& std, int runs) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int below = 0, inside = 0;
  Moments error;
  for (int run = 0; run < runs; ++run) {
    const Eigen::Vector2d r =
        truth + Eigen::Vector2d(std(0) * normal(random), std(1) * normal(random));
    const CrossAxis found =
        cross_axis_sensitivity(r, diagonal(std(0) * std(0), std(1) * std(1))).value();
    below += truth.norm() <= found.upper_95 ? 1 : 0;
    if (!found.value) continue;
    const double miss = found.value->value - truth.norm();
    error.add(miss / found.value->std);
    inside += std::abs(miss) < 1.959964 * found.value->std ? 1 : 0;
  }
  return {static_cast<double>(below) / runs, static_cast<double>(inside) / runs, error.mean};
}

TEST(CrossAxis, IsUnbiasedAndCoversWellAboveTheNoise) {
  for (const Eigen::Vector2d& std : {Eigen::Vector2d(1, 1), Eigen::Vector2d(1, 0.3)}) {
    const Coverage found = repeat({5.0, 4.0}, std, 2000);
    EXPECT_GT(found.interval, 0.93);
    EXPECT_LT(found.interval, 0.97);
    EXPECT_LT(std::abs(found.bias_in_std), 0.08);
  }
}

TEST(CrossAxis, StaysBelowItsBoundAtLeastNineteenTimesInTwenty) {
  for (const double size : {0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0}) {
    EXPECT_GE(repeat({0.6 * size, 0.8 * size}, {1.0, 1.0}, 300).upper, 0.925) << size;
    EXPECT_GE(repeat({0.6 * size, 0.8 * size}, {1.0, 0.3}, 300).upper, 0.925) << size;
  }
}

// Derivatives of √(S_xy² + S_xz²)/S_x, derived by hand.
TEST(CrossAxis, OfAMatrixFollowsTheDeltaMethod) {
  Eigen::Matrix3d S;
  S << 2.0, 0.06, 0.08, 0.01, 1.0, 0.02, 0.03, 0.0, 0.5;
  Eigen::Matrix<double, 9, 9> C = Eigen::Matrix<double, 9, 9>::Zero();
  for (int k = 0; k < 9; ++k) C(k, k) = 1e-8 * (1 + k);
  const auto axes = cross_axis_sensitivities(S, C).value();
  EXPECT_NEAR(axes[0].value.value().value, 0.05, 1e-6);
  const double expected = 0.36 * 2e-8 / 4.0 + 0.64 * 3e-8 / 4.0 + 0.05 * 0.05 * 1e-8 / 4.0;
  EXPECT_NEAR(axes[0].value->std, std::sqrt(expected), 1e-9);
  EXPECT_NEAR(axes[1].value.value().value, std::hypot(0.01, 0.02), 1e-5);
  EXPECT_NEAR(axes[2].value.value().value, 0.06, 1e-5);
}

TEST(CrossAxis, WidensWithFewDegreesOfFreedom) {
  const CrossAxis known = cross_axis_sensitivity({3.0, 1.5}, diagonal(1, 1)).value();
  const CrossAxis few = cross_axis_sensitivity({3.0, 1.5}, diagonal(1, 1), 4.0).value();
  EXPECT_TRUE(known.value);
  EXPECT_FALSE(few.value);
  EXPECT_GT(few.upper_95, known.upper_95);
}

TEST(CrossAxis, RefusesFiguresThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(cross_axis_sensitivity({nan, 0}, diagonal(1, 1)));
  EXPECT_FALSE(cross_axis_sensitivity({0, 0}, diagonal(-1, 1)));
  EXPECT_FALSE(
      cross_axis_sensitivities(Eigen::Matrix3d::Zero(), Eigen::Matrix<double, 9, 9>::Zero()));
}

}  // namespace
}  // namespace proofmass::calibrate::cross_axis_test
