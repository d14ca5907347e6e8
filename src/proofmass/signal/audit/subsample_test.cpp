#include "proofmass/signal/audit/subsample.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <random>

#include "proofmass/signal/clipping_tail.hpp"

namespace proofmass::signal::thinned_sample_test {
namespace {

std::vector<double> ramp(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

std::vector<double> noise(std::size_t n) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  for (double& x : values) x = normal(random);
  return values;
}

TEST(Subsample, IsTheWholeSeriesUpToItsCapacity) {
  Subsample sample(1000);
  const std::vector<double> series = ramp(999);
  sample.add(series);
  EXPECT_TRUE(std::ranges::equal(sample.values(), series));
  EXPECT_EQ(sample.share(), 1.0);
}

TEST(Subsample, HasOneValueOutOfEachOfItsWindows) {
  Subsample sample(64);
  sample.add(ramp(1000));
  // 1000 positions form windows of 16 if at most 64 are kept: 62 whole ones.
  ASSERT_GE(sample.values().size(), 62U);
  ASSERT_LE(sample.values().size(), 63U);
  for (std::size_t k = 0; k < sample.values().size(); ++k)
    EXPECT_EQ(std::floor(sample.values()[k] / 16.0), static_cast<double>(k));
  EXPECT_NEAR(sample.share(), 16.0, 0.3);
}

TEST(Subsample, IsTheSameHoweverTheSeriesIsCut) {
  const std::vector<double> series = noise(30'011);
  Subsample whole(256), pieces(256);
  whole.add(series);
  for (std::size_t from = 0, size = 1; from < series.size();
       from += size, size = size * 7 % 509 + 1)
    pieces.add(View<double>(series).subspan(from, std::min(size, series.size() - from)));
  EXPECT_TRUE(std::ranges::equal(whole.values(), pieces.values()));
  EXPECT_EQ(whole.share(), pieces.share());
}

TEST(Subsample, DoesNotFallIntoStepWithAPeriodOfTheSeries) {
  // Positions a power of two apart would always see the same phase of this series.
  Subsample sample(1024);
  std::vector<double> series(1 << 18);
  for (std::size_t k = 0; k < series.size(); ++k)
    series[k] = std::sin(2.0 * std::numbers::pi * static_cast<double>(k % 256) / 256.0);
  sample.add(series);
  double mean = 0.0, squares = 0.0;
  const auto n = static_cast<double>(sample.values().size());
  for (const double x : sample.values()) {
    mean += x / n;
    squares += x * x / n;
  }
  EXPECT_NEAR(mean, 0.0, 4.0 * std::sqrt(0.5 / n));
  EXPECT_NEAR(squares, 0.5, 4.0 * std::sqrt(0.125 / n));
}

TEST(ClippingTail, CountsExactlyWhatLiesBesideTheExtremeWhileThatIsLittle) {
  std::vector<double> series = noise(50'000);
  for (double& x : series) x = std::round(100.0 * x);
  const auto [low, high] = std::ranges::minmax(series);
  Subsample sample(64);
  ClippingTail lowest(ClippingTail::Side::lowest, 100), highest(ClippingTail::Side::highest, 100);
  for (std::size_t from = 0; from < series.size(); from += 1000) {
    const View<double> part = View<double>(series).subspan(from, 1000);
    sample.add(part);
    lowest.add(part, *std::ranges::min_element(part));
    highest.add(part, *std::ranges::max_element(part));
  }
  const auto beside = [&](double extreme, double width) {
    return static_cast<double>(std::ranges::count_if(
        series, [&](double x) { return x != extreme && std::abs(x - extreme) <= width; }));
  };
  ASSERT_GT(beside(low, 100.0), 10.0);
  ASSERT_LT(beside(low, 100.0), 90.0);
  EXPECT_EQ(lowest.beside(100.0, sample), beside(low, 100.0));
  EXPECT_EQ(highest.beside(100.0, sample), beside(high, 100.0));
}

TEST(ClippingTail, AsksTheSampleWhereItCannotHoldAll) {
  const std::vector<double> series = ramp(100'000);
  Subsample sample(4096);
  ClippingTail lowest(ClippingTail::Side::lowest, 100);
  sample.add(series);
  lowest.add(series, 0.0);
  EXPECT_NEAR(lowest.beside(50'000.0, sample), 50'000.0, 100.0);
}

TEST(ClippingTail, OfNothingHasNothingBeside) {
  EXPECT_EQ(ClippingTail(ClippingTail::Side::lowest).beside(1.0, Subsample()), 0.0);
}

}  // namespace
}  // namespace proofmass::signal::thinned_sample_test
