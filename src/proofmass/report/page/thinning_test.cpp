#include "proofmass/report/page/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace proofmass::report::thinning_test {
namespace {

std::vector<double> counting(std::size_t n) {
  std::vector<double> x(n);
  std::iota(x.begin(), x.end(), 0.0);
  return x;
}

TEST(Thinned, LeavesAShortCurveAsItIs) {
  const std::vector<double> x = counting(40), y(40, 2.0);
  EXPECT_EQ(thinned(x, y, 10).y, y);
}

TEST(Thinned, KeepsASingleSpikeEitherWay) {
  const std::vector<double> x = counting(1'000'000);
  std::vector<double> y(x.size(), 0.0);
  y[123'457] = 9.0;
  y[700'001] = -7.0;
  const Polyline line = thinned(x, y, 1000);
  EXPECT_LE(line.y.size(), 4000U);
  EXPECT_EQ(*std::max_element(line.y.begin(), line.y.end()), 9.0);
  EXPECT_EQ(*std::min_element(line.y.begin(), line.y.end()), -7.0);
  const auto spike = std::find(line.y.begin(), line.y.end(), 9.0) - line.y.begin();
  EXPECT_EQ(line.x[static_cast<std::size_t>(spike)], 123'457.0);
}

TEST(Thinned, KeepsBothEndsAndTheOrder) {
  const std::vector<double> x = counting(9973);
  std::vector<double> y(x.size());
  for (std::size_t k = 0; k < y.size(); ++k) y[k] = std::sin(0.7 * x[k]);
  const Polyline line = thinned(x, y, 50);
  EXPECT_EQ(line.x.front(), x.front());
  EXPECT_EQ(line.x.back(), x.back());
  EXPECT_TRUE(std::is_sorted(line.x.begin(), line.x.end()));
}

TEST(Thinned, LetsAGapBeSeen) {
  const std::vector<double> x = counting(10'000);
  std::vector<double> y(x.size(), 1.0);
  y[5000] = std::nan("");
  const Polyline line = thinned(x, y, 100);
  EXPECT_EQ(std::count_if(line.y.begin(), line.y.end(), [](double v) { return std::isnan(v); }), 1);
}

TEST(Thinned, HasNoValueForGapsOnly) {
  const std::vector<double> x = counting(10'000), y(x.size(), std::nan(""));
  for (const double value : thinned(x, y, 100).y) EXPECT_TRUE(std::isnan(value));
}

TEST(ThinnedBand, HoldsEveryBound) {
  const std::vector<double> x = counting(10'000);
  std::vector<double> lower(x.size(), -1.0), upper(x.size(), 1.0);
  lower[3333] = -5.0;
  upper[6666] = 6.0;
  upper[6667] = std::nan("");
  const Envelope band = thinned_band(x, lower, upper, 100);
  EXPECT_EQ(band.x.size(), 100U);
  EXPECT_EQ(*std::min_element(band.lower.begin(), band.lower.end()), -5.0);
  EXPECT_EQ(*std::max_element(band.upper.begin(), band.upper.end()), 6.0);
  EXPECT_EQ(band.x.front(), 0.0);
  EXPECT_EQ(band.x.back(), 9999.0);
}

}  // namespace
}  // namespace proofmass::report::thinning_test
