#include "proofmass/signal/range_end.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::signal {
namespace {

std::vector<double> swings(double noise, double step, double limit) {
  std::vector<double> out;
  Random random(1, "noise");
  for (int k = 0; k < 2000; ++k) {
    const double value = std::sin(0.02 * k) * std::cos(0.0031 * k) + noise * random.normal();
    out.push_back(std::clamp(std::round(value / step) * step, -limit - step, limit));
  }
  return out;
}

std::ptrdiff_t marked(const std::vector<double>& series) {
  return std::ranges::count(at_range_end(series), true);
}

TEST(RangeEnd, OfAConverterWhoseNegativeEndIsOneCodeFarther) {
  const std::vector<double> series = swings(1e-3, 1e-3, 0.7);
  const std::vector<bool> at_end = at_range_end(series);
  int low = 0, high = 0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!at_end[k]) continue;
    EXPECT_GE(std::abs(series[k]), 0.699);
    ++(series[k] < 0.0 ? low : high);
  }
  EXPECT_GT(low, 100);
  EXPECT_GT(high, 100);
}

TEST(RangeEnd, IsNoCrestOfACoarseConverterAndNoRest) {
  EXPECT_EQ(marked(swings(0.0, 0.05, 2.0)), 0);
  EXPECT_EQ(marked(swings(1e-4, 0.01, 2.0)), 0);
  // At rest at its lowest value, and turned in one direction.
  std::vector<double> series(300, 0.02);
  for (int k = 0; k < 100; ++k)
    series[static_cast<std::size_t>(100 + k)] = 0.02 + std::sin(0.0314 * k);
  EXPECT_EQ(marked(series), 0);
}

TEST(RangeEnd, IsEveryValueOfAConstantChannelButNotNan) {
  std::vector<double> series(50, 3.0);
  series[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(marked(series), 49);
  EXPECT_EQ(marked({}), 0);
  std::array<std::vector<double>, 3> axes;
  axes.fill(std::vector<double>(2000, 0.0));
  axes[1] = swings(1e-3, 1e-3, 0.7);
  const std::vector<bool> rows = saturated_rows(axes);
  EXPECT_EQ(std::ranges::count(rows, true), marked(axes[1]));
  EXPECT_EQ(drop_rows(rows, axes), static_cast<std::size_t>(std::ranges::count(rows, true)));
  for (std::size_t row = 0; row < rows.size(); ++row)
    EXPECT_EQ(std::isnan(axes[0][row]), rows[row]) << row;
}

}  // namespace
}  // namespace proofmass::signal
