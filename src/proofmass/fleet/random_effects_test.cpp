#include "proofmass/fleet/random_effects.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/fleet/fleet_test_support.hpp"

namespace proofmass::fleet::random_effects_test {
namespace {

// Source: G. W. Snedecor, W. G. Cochran, Statistical Methods (7th ed., 1980), section 13.3: calcium
// in turnip leaves; mean squares 0.2961 between and 0.0066 within, component between leaves 0.0724.
TEST(RandomEffects, OfCalciumInTurnipLeavesAreThoseOfTheTextbook) {
  const auto fit = fit_random_effects({{{3.28, 3.09, 3.03, 3.03}, {}},
                                       {{3.52, 3.48, 3.38, 3.38}, {}},
                                       {{2.88, 2.80, 2.81, 2.76}, {}},
                                       {{3.34, 3.38, 3.23, 3.26}, {}}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->mean.value, 3.165625, 1e-9);
  EXPECT_NEAR(fit->mean.std * fit->mean.std * 16.0, 0.2961, 5e-5);
  EXPECT_NEAR(fit->between_std * fit->between_std, 0.0724, 5e-5);
  EXPECT_NEAR(*fit->within_std * *fit->within_std, 0.0066, 5e-5);
}

// With no scatter within, the interval between is that of a variance: chi-square of 9 degrees of
// freedom, whose 2.5 % and 97.5 % points are 2.700 and 19.023 (Pearson and Hartley, Biometrika
// Tables, table 8).
TEST(RandomEffects, WithoutScatterWithinHaveTheIntervalOfAVariance) {
  std::vector<SensorValues> sensors;
  for (int k = 0; k < 10; ++k) sensors.push_back({{1.0 * k, 1.0 * k + 1e-9}, {}});
  const auto fit = fit_random_effects(sensors);
  ASSERT_TRUE(fit);
  const double squares = 82.5;  // Σ (k − 4.5)²
  EXPECT_NEAR(fit->between_std, std::sqrt(squares / 9.0), 1e-6);
  EXPECT_NEAR(fit->between_95.lower, std::sqrt(squares / 19.023), 1e-3);
  EXPECT_NEAR(fit->between_95.upper, std::sqrt(squares / 2.700), 1e-3);
}

TEST(RandomEffects, OfSingleValuesWithoutStandardDeviationHaveTheSameInterval) {
  std::vector<SensorValues> sensors;
  for (int k = 0; k < 10; ++k) sensors.push_back({{1.0 * k}, {}});
  const auto fit = fit_random_effects(sensors);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->between_std, std::sqrt(82.5 / 9.0), 1e-6);
  EXPECT_NEAR(fit->between_95.upper, std::sqrt(82.5 / 2.700), 1e-3);
  EXPECT_FALSE(fit->within_std);
}

TEST(RandomEffects, OfValuesThatTheirOwnErrorsExplainAreNone) {
  std::vector<SensorValues> sensors;
  for (int k = 0; k < 10; ++k) sensors.push_back({{0.01 * k}, {1.0}});
  const auto fit = fit_random_effects(sensors);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->between_std, 0.0);
  EXPECT_EQ(fit->between_95.lower, 0.0);
}

TEST(RandomEffects, NeedThreeSensors) {
  EXPECT_FALSE(fit_random_effects({{{1.0, 2.0}, {}}, {{2.0, 3.0}, {}}}));
}

// 500 fleets: 95 % is 475 with a standard deviation of 5; 93 to 97 % are asked for.
TEST(RandomEffects, IntervalsHoldIn93To97PercentOf500Fleets) {
  Coverage coverage;
  const std::vector<std::size_t> counts(20, 5);
  for (std::size_t k = 0; k < 500; ++k) {
    Random random(11, "balanced", k);
    const auto fit = fit_random_effects(drawn_fleet(random, 0.3, 0.2, counts));
    ASSERT_TRUE(fit);
    coverage.mean += holds(fit->mean_95, 3.0) ? 1 : 0;
    coverage.between += holds(fit->between_95, 0.3) ? 1 : 0;
    coverage.within += holds(fit->within_95, 0.2) ? 1 : 0;
  }
  for (const std::size_t held : {coverage.mean, coverage.between, coverage.within}) {
    EXPECT_GE(held, 465U);
    EXPECT_LE(held, 485U);
  }
}

TEST(RandomEffects, IntervalsHoldWhereEachSensorHasOneValueOfKnownAccuracy) {
  Coverage coverage;
  for (std::size_t k = 0; k < 500; ++k) {
    Random random(12, "singles", k);
    std::vector<SensorValues> sensors;
    for (int sensor = 0; sensor < 20; ++sensor) {
      const double std = 0.1 + 0.2 * random.unit();
      sensors.push_back({{3.0 + 0.3 * random.normal() + std * random.normal()}, {std}});
    }
    const auto fit = fit_random_effects(sensors);
    ASSERT_TRUE(fit);
    coverage.mean += holds(fit->mean_95, 3.0) ? 1 : 0;
    coverage.between += holds(fit->between_95, 0.3) ? 1 : 0;
  }
  for (const std::size_t held : {coverage.mean, coverage.between}) {
    EXPECT_GE(held, 465U);
    EXPECT_LE(held, 485U);
  }
}

}  // namespace
}  // namespace proofmass::fleet::random_effects_test
