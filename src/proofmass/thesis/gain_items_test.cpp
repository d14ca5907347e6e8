#include "proofmass/thesis/gain_items.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/thesis/gain/figures.hpp"
#include "proofmass/thesis/gain/readings.hpp"

namespace proofmass::thesis::gain_items_test {
namespace {

const std::vector<Item>& items() {
  static const std::vector<Item> all = gain_items(1);
  return all;
}

double ours(std::string_view id, std::string_view key) {
  const auto item = std::ranges::find(items(), id, &Item::id);
  EXPECT_NE(item, items().end()) << id;
  const auto found = std::ranges::find(item->findings, key, &Finding::key);
  EXPECT_NE(found, item->findings.end()) << key;
  return found->ours.value().value;
}

// The same Riccati recursion, for the third column only and in scalars.
struct Recursion {
  double pa, va, aa;  // covariance of position, velocity and acceleration with the acceleration
};

std::vector<std::array<double, 3>> gains(double q, double R, std::size_t steps) {
  constexpr double h = 0.2;
  Recursion P{.pa = 0.0, .va = 0.0, .aa = 100.0};
  std::vector<std::array<double, 3>> out;
  for (std::size_t k = 0; k < steps; ++k) {
    if (k > 0)
      P = {.pa = P.pa + h * P.va + h * h / 2.0 * P.aa + q * h * h * h / 6.0,
           .va = P.va + h * P.aa + q * h * h / 2.0,
           .aa = P.aa + q * h};
    const double S = P.aa + R;
    out.push_back({P.pa / S, P.va / S, P.aa / S});
    P = {.pa = P.pa * R / S, .va = P.va * R / S, .aa = P.aa * R / S};
  }
  return out;
}

double settled_s(const std::vector<std::array<double, 3>>& all, std::size_t state, double within) {
  const double limit = all.back()[state];
  std::size_t k = all.size();
  while (k > 0 && std::abs(all[k - 1][state] - limit) <= within * limit) --k;
  return 0.2 * static_cast<double>(k);
}

TEST(GainItems, SettlingTimesAreThoseOfARiccatiRecursionWrittenOutByHand) {
  const auto quick = gains(4.0, 1.0, 5000), slow = gains(1.0, 4.0, 5000);
  EXPECT_NEAR(ours("figure 5.8", "settling"), settled_s(quick, 0, 0.02), 1e-9);
  EXPECT_NEAR(ours("figure 5.8", "settling_fine"), settled_s(quick, 0, 1e-3), 1e-9);
  EXPECT_NEAR(ours("figure 5.8", "settling_acceleration"), settled_s(quick, 2, 0.02), 1e-9);
  EXPECT_NEAR(ours("figure 5.10", "settling"), settled_s(slow, 0, 0.02), 1e-9);
  EXPECT_NEAR(ours("figure 5.10", "settling_fine"), settled_s(slow, 0, 1e-3), 1e-9);
  EXPECT_NEAR(ours("figure 5.10", "settling_acceleration"), settled_s(slow, 2, 0.02), 1e-9);
  EXPECT_NEAR(ours("figure 5.10", "gain"), slow.back()[2], 1e-9);
}

TEST(GainItems, TheThesissTwoSettlingTimesAreTheSameNumberOfTimeConstants) {
  const double quick = 2.0 / ours("figure 5.8", "time_constant");
  const double slow = 8.0 / ours("figure 5.10", "time_constant");
  EXPECT_NEAR(quick / slow, 1.0, 0.05);
}

TEST(GainItems, AnErrorOfTheAccelerationFallsWithTheTimeConstant) {
  for (const auto& options : {quick_filter, slow_filter}) {
    const auto study = gain_study(options);
    const double constant_s = filter_response(study, 1.0).time_constant_s;
    double error = 1.0;  // of the settled filter without noise: a factor of (1 − k) per step
    for (int k = 0; k < 50; ++k) error *= 1.0 - study.limit[2];
    EXPECT_NEAR(error, std::exp(-50 * 0.2 / constant_s), 1e-12);
  }
}

// Noise through the settled filter, R k/(2 − k), and the error due to lag for the sine, |1 − H|²/2.
TEST(GainItems, TheFiltersErrorIsItsNoiseAndItsLag) {
  for (const auto& options : {quick_filter, slow_filter}) {
    const double k = gain_study(options).limit[2], c = std::cos(0.2), s = std::sin(0.2);
    const double away = (1.0 - k) * (1.0 - k) * (2.0 - 2.0 * c);
    const double down =
        (1.0 - (1.0 - k) * c) * (1.0 - (1.0 - k) * c) + (1.0 - k) * (1.0 - k) * s * s;
    const double expected =
        std::sqrt(options.accel_variance_m2ps4 * k / (2.0 - k) + 0.5 * away / down);
    for (const auto axis : {SimulatedAxis::x, SimulatedAxis::y}) {
      const ReadingErrors found = reading_errors(options, axis, 7, 40);
      const double mean_std = found.filtered.std / std::sqrt(40.0);
      // The first measurements, before the filter has settled, contribute a little.
      EXPECT_NEAR(found.filtered.value, expected, 4.0 * mean_std + 0.01);
      EXPECT_LT(found.smoothed.value, found.filtered.value);
      EXPECT_NEAR(found.reading.value, std::sqrt(options.accel_variance_m2ps4),
                  4.0 * found.reading.std / std::sqrt(40.0));
    }
  }
}

TEST(GainItems, TheResponseIsThatOfTheFilterToASineWithoutNoise) {
  for (const auto& options : {quick_filter, slow_filter}) {
    const auto study = gain_study(options);
    const FilterResponse response = filter_response(study, 1.0);
    double state = 0.0, worst = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const double t = 0.2 * k;
      state += study.limit[2] * (std::sin(t) - state);
      if (k > 500)
        worst =
            std::max(worst, std::abs(state - response.amplitude * std::sin(t - response.delay_s)));
    }
    EXPECT_LT(worst, 1e-9);
  }
}

TEST(GainItems, BelowTenComesTheVarianceWithTheRThatIsNamedJustAfterTwentyReadings) {
  auto options = slow_filter;
  options.accel_variance_m2ps4 = ours("figure 4.3", "r_for_twenty");
  const auto study = gain_study(options);
  EXPECT_GT(study.epochs[18].variance[2], 10.0);
  EXPECT_LE(study.epochs[19].variance[2], 10.0);
  EXPECT_NEAR(study.epochs[19].variance[2], 10.0, 0.02);
  EXPECT_EQ(ours("figure 4.3", "readings_to_ten_slow"), 1.0);
}

TEST(GainItems, ALongerStepLeavesMoreVariance) {
  EXPECT_LT(ours("figure 4.3", "limit_variance_0p05_s"),
            ours("figure 4.3", "limit_variance_0p2_s"));
  EXPECT_LT(ours("figure 4.3", "limit_variance_0p2_s"), ours("figure 4.3", "limit_variance_1_s"));
}

// If the acceleration is known at once, the position variance due to P₀ is P₀ (1 + t²), and that
// due to jerk is below q t⁵/20, its value without measurements.
TEST(GainItems, ThePositionIsLeftWithAtLeastTheVelocityOfTheStart) {
  for (const char* id : {"figure 5.8", "figure 5.10"}) {
    EXPECT_GT(ours(id, "position_std"), std::sqrt(100.0 * (1.0 + 100.0 * 100.0)));
    EXPECT_LT(ours(id, "position_std"), std::sqrt(100.0 * (1.0 + 1e4) + 4.0 * 1e10 / 20.0));
    EXPECT_GT(ours(id, "velocity_std"), 10.0);
  }
}

TEST(GainItems, WhatIsAbsentHasAReason) {
  for (const Item& item : items())
    for (const Finding& f : item.findings)
      EXPECT_EQ(f.reason.empty(), f.ours.has_value()) << item.id << ' ' << f.key;
}

}  // namespace
}  // namespace proofmass::thesis::gain_items_test
