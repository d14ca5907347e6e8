#include "proofmass/fit/minimise_smooth.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::fit::minimise_smooth_test {
namespace {

// H. H. Rosenbrock, Comput. J. 3 (1960) 175: a curved valley with its minimum at (1, 1).
double rosenbrock(View<double> p, std::span<double> slope) {
  const double along = 1.0 - p[0], across = p[1] - p[0] * p[0];
  slope[0] = -2.0 * along - 400.0 * p[0] * across;
  slope[1] = 200.0 * across;
  return along * along + 100.0 * across * across;
}

TEST(MinimiseSmooth, FollowsTheBananaValleyToItsEnd) {
  const auto found = minimise_smooth(rosenbrock, {-1.2, 1.0});
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->converged);
  EXPECT_NEAR(found->parameters[0], 1.0, 1e-8);
  EXPECT_NEAR(found->parameters[1], 1.0, 1e-8);
  EXPECT_LT(found->gradient, 1e-8);
}

TEST(MinimiseSmooth, StepsBackWhereTheFunctionIsNotDefined) {
  const SmoothFunction barrier = [](View<double> p, std::span<double> slope) {
    if (p[0] <= 0.0) return std::numeric_limits<double>::quiet_NaN();
    slope[0] = 1.0 - 1.0 / p[0];
    return p[0] - std::log(p[0]);
  };
  const auto found = minimise_smooth(barrier, {30.0});
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->parameters[0], 1.0, 1e-7);
}

TEST(MinimiseSmooth, SaysWhyItCannot) {
  EXPECT_EQ(minimise_smooth(rosenbrock, {}).error().code, Errc::invalid_argument);
  const SmoothFunction nowhere = [](View<double>, std::span<double>) {
    return std::numeric_limits<double>::infinity();
  };
  EXPECT_EQ(minimise_smooth(nowhere, {0.0}).error().code, Errc::not_finite);
}

}  // namespace
}  // namespace proofmass::fit::minimise_smooth_test
