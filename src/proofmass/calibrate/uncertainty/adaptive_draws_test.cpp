#include "proofmass/calibrate/uncertainty/adaptive_draws.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/calibrate/uncertainty/draw.hpp"
#include "proofmass/calibrate/uncertainty/monte_carlo.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::calibrate::adaptive_draws_test {
namespace {

// Outputs that are normal with these standard deviations.
AdaptiveDraws of_normal(const std::vector<double>& std, const AdaptiveOptions& options) {
  const FillBatch fill = [&](std::size_t batch, std::span<std::vector<double>> columns) {
    Draw draw(100 + batch);
    for (std::size_t j = 0; j < columns.size(); ++j)
      for (std::size_t k = 0; k < options.batch; ++k) columns[j].push_back(std[j] * draw.normal());
  };
  return draw_until_stable(std.size(), fill, options);
}

// The example of JCGM 101, 9.2.2: the sum of four standard normal quantities is 0 with u = 2.0 and
// the interval ± 3.92; two digits of 2.0 mean a tolerance of 0.05.
TEST(DrawUntilStable, GivesTwoDigitsOfTheGuidesExample) {
  const AdaptiveDraws found = of_normal({2.0}, {});
  EXPECT_TRUE(found.stable);
  EXPECT_LT(found.columns[0].size(), 1000000U);
  EXPECT_EQ(found.columns[0].size() % 10000, 0U);
  const Propagation y = summary_of(found.columns[0]).value();
  EXPECT_NEAR(y.mean, 0.0, 0.05);
  EXPECT_NEAR(y.std, 2.0, 0.05);
  EXPECT_NEAR(y.symmetric_95.lower, -3.92, 0.05);
  EXPECT_NEAR(y.symmetric_95.upper, 3.92, 0.05);
}

// An end of the interval has a standard error of √(p (1 − p)/n)/φ = 2.67 u/√n; twice that is below
// 0.5 % of u = 9.9 after n = 1.1e6, below 5 % of u = 1.0 after 1.1e4.
TEST(DrawUntilStable, TakesTheDrawsThatTheLeastStableOutputNeeds) {
  EXPECT_LE(of_normal({1.01}, {}).columns[0].size(), 100000U);
  EXPECT_GE(of_normal({1.01, 5.0}, {}).columns[0].size(), 20000U);
  const AdaptiveDraws most = of_normal({1.01, 9.9}, {.most = 200000});
  EXPECT_FALSE(most.stable);
  EXPECT_EQ(most.columns[1].size(), 200000U);
  EXPECT_TRUE(of_normal({9.9}, {.digits = 1}).stable);
}

TEST(DrawUntilStable, IsNotStableWithoutResults) {
  const AdaptiveDraws found =
      draw_until_stable(1,
                        [](std::size_t, std::span<std::vector<double>> columns) {
                          columns[0].assign(1000, no_value);
                        },
                        {.batch = 1000, .most = 4000});
  EXPECT_FALSE(found.stable);
  EXPECT_EQ(found.columns[0].size(), 4000U);
}

TEST(DrawUntilStable, AcceptsOutputsWithoutUncertainty) {
  const AdaptiveDraws found = of_normal({0.0}, {});
  EXPECT_TRUE(found.stable);
  EXPECT_EQ(found.columns[0].size(), 20000U);
}

}  // namespace
}  // namespace proofmass::calibrate::adaptive_draws_test
