#include "proofmass/core/random.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "proofmass/core/statistics.hpp"

namespace proofmass::random_test {
namespace {

TEST(Random, GivesTheSameNumbersForTheSameStreamOnly) {
  Random a(7, "noise", 2), b(7, "noise", 2), other_seed(8, "noise", 2), other_use(7, "bias", 2),
      other_index(7, "noise", 3);
  const double first = a.normal();
  EXPECT_EQ(first, b.normal());
  EXPECT_NE(first, other_seed.normal());
  EXPECT_NE(first, other_use.normal());
  EXPECT_NE(first, other_index.normal());
}

// Recordings are identified by their seed: a change of any number here changes all of them.
TEST(Random, GivesTheNumbersThatItAlwaysGave) {
  EXPECT_EQ(Random(7, "noise", 2).uniform(), 0x1.146b28873ce96p-1);
}

// Moments of 200 000 draws; the bounds are five standard deviations of each.
TEST(Random, NormalNumbersHaveTheMomentsOfANormal) {
  Random random(1, "moments");
  constexpr int n = 200000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0, lag = 0, before = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    m1 += x;
    m2 += x * x;
    m3 += x * x * x;
    m4 += x * x * x * x;
    lag += x * before;
    before = x;
  }
  const double s = 5.0 / std::sqrt(n);
  EXPECT_NEAR(m1 / n, 0.0, s);
  EXPECT_NEAR(m2 / n, 1.0, s * std::sqrt(2.0));
  EXPECT_NEAR(m3 / n, 0.0, s * std::sqrt(15.0));
  EXPECT_NEAR(m4 / n, 3.0, s * std::sqrt(96.0));
  EXPECT_NEAR(lag / n, 0.0, s);
}

TEST(Random, UniformNumbersFillTheirRange) {
  Random random(1, "range");
  Moments seen;
  for (int i = 0; i < 100000; ++i) seen.add(random.uniform());
  EXPECT_GE(seen.min, -1.0);
  EXPECT_LT(seen.max, 1.0);
  EXPECT_LT(seen.min, -0.999);
  EXPECT_GT(seen.max, 0.999);
  EXPECT_NEAR(seen.std(), 1.0 / std::numbers::sqrt3, 0.01);
}

}  // namespace
}  // namespace proofmass::random_test
