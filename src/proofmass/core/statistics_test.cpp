#include "proofmass/core/statistics.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace proofmass::statistics_test {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Moments, OfOneToFive) {
  const Moments m = moments(std::vector{1.0, 2.0, 3.0, 4.0, 5.0});
  EXPECT_DOUBLE_EQ(m.mean, 3.0);
  EXPECT_DOUBLE_EQ(m.std(), std::sqrt(2.5));
  EXPECT_EQ(m.min, 1.0);
  EXPECT_EQ(m.max, 5.0);
}

TEST(Moments, LoseNothingToALargeMean) {
  const Moments m = moments(std::vector{1e9 + 4.0, 1e9 + 7.0, 1e9 + 13.0, 1e9 + 16.0});
  EXPECT_DOUBLE_EQ(m.std(), std::sqrt(30.0));
}

TEST(Moments, PassOverAndCountWhatIsNotFinite) {
  const Moments m = moments(std::vector{nan, 2.0, std::numeric_limits<double>::infinity(), 4.0});
  EXPECT_EQ(m.count, 2U);
  EXPECT_EQ(m.nonfinite, 2U);
  EXPECT_DOUBLE_EQ(m.mean, 3.0);
}

TEST(Quantile, LiesBetweenOrderStatistics) {
  const std::vector<double> series{4.0, nan, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(quantile(series, 0.0).value(), 1.0);
  EXPECT_DOUBLE_EQ(median(series).value(), 2.5);
  EXPECT_DOUBLE_EQ(quantile(series, 1.0).value(), 4.0);
  EXPECT_FALSE(median(std::vector{nan}));
}

TEST(RobustStd, SeesThroughOutliers) {
  std::mt19937_64 rng(7);
  std::normal_distribution<double> normal(5.0, 0.25);
  std::vector<double> series(20000);
  for (double& x : series) x = normal(rng);
  for (std::size_t i = 0; i < series.size(); i += 10) series[i] = 3e34;
  EXPECT_NEAR(robust_std(series).value(), 0.25, 0.05);
}

}  // namespace
}  // namespace proofmass::statistics_test
