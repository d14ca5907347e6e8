#include "proofmass/signal/spectrum/regress_out.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace proofmass::signal::regress_out_test {
namespace {

std::vector<double> slow_cause(std::size_t n) {
  std::vector<double> u(n);
  for (std::size_t k = 0; k < n; ++k) {
    u[k] = 25.0 + 3.0 * std::sin(2.0 * static_cast<double>(k) / static_cast<double>(n));
  }
  return u;
}

TEST(RegressOut, LeavesAConstantWhereTheSeriesIsALineOfTheCause) {
  std::vector<double> u(4096);
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = 20.0 + 1e-3 * static_cast<double>(k);
  std::vector<double> y(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) y[k] = 4.0 - 0.7 * u[k];
  const double mean_u = 20.0 + 1e-3 * 4095.0 / 2.0;
  const auto c = regress_out(y, u);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->value, -0.7, 1e-12);
  for (const double left : y) EXPECT_NEAR(left, 4.0 - 0.7 * mean_u, 1e-9);
}

TEST(RegressOut, FindsTheCoefficientWithinItsStdThreeTimesOutOfFour) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  int inside = 0;
  constexpr int records = 200;
  for (int record = 0; record < records; ++record) {
    const std::vector<double> u = slow_cause(4000);
    std::vector<double> y(u.size());
    for (std::size_t k = 0; k < u.size(); ++k) y[k] = 0.02 * u[k] + noise(random);
    const auto c = regress_out(y, u);
    ASSERT_TRUE(c);
    if (std::abs(c->value - 0.02) < c->std) ++inside;
  }
  EXPECT_GT(inside, 0.58 * records);
  EXPECT_LT(inside, 0.80 * records);
}

TEST(RegressOut, DoesNotBringTheNoiseOfTheCauseIntoTheSeries) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> noise;
  std::vector<double> u = slow_cause(100'000), y(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) {
    y[k] = 2.0 * u[k];
    u[k] += 0.5 * noise(random);
  }
  ASSERT_TRUE(regress_out(y, u));
  double squares = 0.0;
  for (std::size_t k = 1; k < y.size(); ++k) squares += (y[k] - y[k - 1]) * (y[k] - y[k - 1]);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(y.size())), 1e-3);
}

TEST(RegressOut, PassesOverWhatIsMissing) {
  std::vector<double> u = slow_cause(8000), y(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) y[k] = 2.0 * u[k];
  for (std::size_t k = 1000; k < 2000; ++k) y[k] = std::nan("");
  for (std::size_t k = 5000; k < 5010; ++k) u[k] = std::nan("");
  const auto c = regress_out(y, u);
  ASSERT_TRUE(c);
  EXPECT_NEAR(c->value, 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(y[1500]));
  EXPECT_TRUE(std::isfinite(y[5005]));
}

TEST(RegressOut, SaysWhyItCannot) {
  std::vector<double> y(4000, 1.0);
  const auto constant = regress_out(y, std::vector<double>(4000, 25.0));
  ASSERT_FALSE(constant);
  EXPECT_EQ(constant.error().code, Errc::not_observable);
  std::vector<double> few(100, 1.0);
  const auto too_few = regress_out(few, slow_cause(100));
  ASSERT_FALSE(too_few);
  EXPECT_EQ(too_few.error().code, Errc::too_few_samples);
}

}  // namespace
}  // namespace proofmass::signal::regress_out_test
