#include "proofmass/estimate/wheel/fix_scatter.hpp"

#include <gtest/gtest.h>
#include <random>

namespace proofmass::estimate {
namespace {

constexpr double count_rad2 = 1e-8;  // explained by the width of the counts
constexpr double constant_rad2 = 4e-8, stamps_s2 = 1e-9;

/// Innovations at speeds from `slow` to `fast`, one in `wild_each` ten times too large; 0: none.
FixScatter scatter(double slow_radps, double fast_radps, unsigned wild_each = 0) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> speed(slow_radps, fast_radps);
  FixScatter fixes;
  for (unsigned k = 0; k < 20'000; ++k) {
    const double w = slow_radps < fast_radps ? speed(random) : slow_radps;
    const double variance = count_rad2 + constant_rad2 + square(w) * stamps_s2;
    const double size = wild_each > 0 && k % wild_each == 0 ? 10.0 : 1.0;
    fixes.add(w, size * std::sqrt(variance) * normal(random), count_rad2);
  }
  return fixes;
}

TEST(FixScatter, SeparatesStampsFromTheRestByTheSpeed) {
  const auto noise = scatter(0.0, 30.0).noise();
  ASSERT_TRUE(noise);
  EXPECT_NEAR(noise->stamps_s2, stamps_s2, 0.1 * stamps_s2);
  EXPECT_NEAR(noise->constant_rad2, constant_rad2, 0.3 * constant_rad2);
}

TEST(FixScatter, IsConstantAtOneSpeed) {
  const auto noise = scatter(20.0, 20.0).noise();
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->stamps_s2, 0.0);
  const double expected_rad2 = constant_rad2 + square(20.0) * stamps_s2;
  EXPECT_NEAR(noise->constant_rad2, expected_rad2, 0.05 * expected_rad2);
}

TEST(FixScatter, TakesLittleFromWildFixes) {
  const auto noise = scatter(20.0, 20.0, 100).noise();
  ASSERT_TRUE(noise);
  EXPECT_LT(noise->constant_rad2, 1.2 * (constant_rad2 + square(20.0) * stamps_s2));
}

TEST(FixScatter, IsUnknownFromAFewAndIgnoresWhatIsNotFinite) {
  FixScatter fixes;
  for (int k = 0; k < 39; ++k) fixes.add(1.0, 1e-3, 0.0);
  fixes.add(1.0, std::nan(""), 0.0);
  EXPECT_FALSE(fixes.noise());
  fixes.add(1.0, 1e-3, 0.0);
  ASSERT_TRUE(fixes.noise());
  EXPECT_NEAR(fixes.noise()->constant_rad2, 1e-6, 1e-12);
}

}  // namespace
}  // namespace proofmass::estimate
