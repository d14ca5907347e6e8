#include "proofmass/fit/differences.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::fit::differences_test {
namespace {

// A scalar function as a vector of length one.
Along along(double (*f)(double)) {
  return [=](double t, Eigen::VectorXd& out) {
    out.setConstant(1, f(t));
    return out.allFinite();
  };
}

TEST(Derivative, HasElevenDigitsOfASmoothFunction) {
  const auto slope = [](double t, double scale) {
    return derivative(along([](double x) { return std::exp(std::sin(x)); }), t, {.scale = scale},
                      1)(0);
  };
  for (const double t : {-2.0, 0.3, 1.0, 40.0}) {
    const double exact = std::cos(t) * std::exp(std::sin(t));
    EXPECT_NEAR(slope(t, 1.0), exact, 1e-11) << t;
    EXPECT_NEAR(slope(t, std::abs(t)), exact, 1e-11) << t;
  }
}

TEST(Derivative, ShortensItsStepsForARapidFunction) {
  const auto f = along([](double x) { return std::sin(1e6 * x); });
  EXPECT_NEAR(derivative(f, 1.0, {.scale = 1.0}, 1)(0) / (1e6 * std::cos(1e6)), 1.0, 1e-6);
}

TEST(Derivative, StaysWithinTheBounds) {
  const auto root = along([](double x) { return x * std::sqrt(x); });
  EXPECT_NEAR(derivative(root, 1.0, {.scale = 1.0, .lower = 1.0}, 1)(0), 1.5, 1e-9);
  EXPECT_NEAR(derivative(root, 1.0, {.scale = 1.0, .upper = 1.0}, 1)(0), 1.5, 1e-9);
  EXPECT_NEAR(derivative(root, 1.0, {.scale = 1.0, .lower = 0.998, .upper = 1.002}, 1)(0), 1.5,
              1e-9);
}

TEST(Derivative, GoesCloserWhereTheFunctionIsNotFinite) {
  const auto log = along([](double x) { return std::log(x); });
  EXPECT_NEAR(derivative(log, 1e-3, {.scale = 1.0}, 1)(0), 1e3, 1e-6);
}

TEST(Derivative, OfNothingFiniteIsZero) {
  const auto nowhere = along([](double) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_EQ(derivative(nowhere, 1.0, {.scale = 1.0}, 1)(0), 0.0);
}

}  // namespace
}  // namespace proofmass::fit::differences_test
