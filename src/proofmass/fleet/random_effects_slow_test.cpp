#include <gtest/gtest.h>

#include "proofmass/fleet/fleet_test_support.hpp"

namespace proofmass::fleet::random_effects_slow_test {
namespace {

Coverage coverage_of(double between, const std::vector<std::size_t>& counts, std::size_t fleets) {
  Coverage coverage;
  for (std::size_t k = 0; k < fleets; ++k) {
    Random random(21, "coverage", k);
    const auto fit = fit_random_effects(drawn_fleet(random, between, 0.2, counts));
    if (!fit) return {};
    coverage.mean += holds(fit->mean_95, 3.0) ? 1 : 0;
    coverage.between += holds(fit->between_95, between) ? 1 : 0;
    coverage.within += holds(fit->within_95, 0.2) ? 1 : 0;
  }
  return coverage;
}

// Small and large fleets, few and many values a sensor, little and much scatter between: 93 to 97
// %.
TEST(RandomEffectsCoverage, HoldsOverSizesAndScatters) {
  constexpr std::size_t fleets = 4000;
  for (const std::size_t sensors : {5, 20, 100})
    for (const std::size_t values : {2, 10})
      for (const double between : {0.1, 0.3, 1.0}) {
        const Coverage held =
            coverage_of(between, std::vector<std::size_t>(sensors, values), fleets);
        SCOPED_TRACE(testing::Message()
                     << sensors << " sensors, " << values << " values, " << between);
        EXPECT_NEAR(static_cast<double>(held.mean) / fleets, 0.95, 0.02);
        EXPECT_NEAR(static_cast<double>(held.between) / fleets, 0.95, 0.02);
        EXPECT_NEAR(static_cast<double>(held.within) / fleets, 0.95, 0.02);
      }
}

// One to ten values a sensor.
TEST(RandomEffectsCoverage, HoldsWhereSensorsHaveDifferentNumbersOfValues) {
  constexpr std::size_t fleets = 4000;
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k < 20; ++k) counts.push_back(1 + k % 10);
  const Coverage held = coverage_of(0.3, counts, fleets);
  EXPECT_NEAR(static_cast<double>(held.mean) / fleets, 0.95, 0.02);
  EXPECT_NEAR(static_cast<double>(held.between) / fleets, 0.95, 0.02);
}

}  // namespace
}  // namespace proofmass::fleet::random_effects_slow_test
