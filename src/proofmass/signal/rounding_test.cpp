#include "proofmass/signal/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/core/random.hpp"

namespace proofmass::signal {
namespace {

TEST(Rounding, NoiseOfAStepDithersItAway) {
  std::vector<double> coarse, dithered;
  Random random(5, "dither");
  for (int k = 0; k < 4000; ++k) {
    coarse.push_back(std::round(0.3 + 0.05 * random.normal()));
    dithered.push_back(std::round(0.3 + 1.0 * random.normal()));
  }
  EXPECT_NEAR(rounding_variance(coarse, 1.0), 1.0 / 12.0, 1e-12);
  EXPECT_LT(rounding_variance(dithered, 1.0), 1e-12);
}

// The reference: errors of means of many values at positions all over a step.
TEST(Rounding, WithLittleNoiseIsNotUnderestimatedAtAnyPosition) {
  constexpr int positions = 50, count = 400;
  for (const double noise : {0.15, 0.25, 0.3, 0.35, 0.45}) {
    double stated = 0.0, squares = 0.0, worst = 0.0;
    for (int i = 0; i < positions; ++i) {
      Random random(static_cast<std::uint64_t>(i), "position");
      const double at = static_cast<double>(i) / positions;
      std::vector<double> values;
      for (int k = 0; k < count; ++k) values.push_back(std::round(at + noise * random.normal()));
      const double variance = rounding_variance(values, 1.0);
      stated += variance / positions;
      Random many(1, "mean");
      double sum = 0.0;
      constexpr int long_mean = 20'000;
      for (int k = 0; k < long_mean; ++k) sum += std::round(at + noise * many.normal());
      const double error = sum / long_mean - at;
      squares += error * error / positions;
      worst = std::max(worst, std::abs(error) / std::sqrt(variance));
    }
    EXPECT_GT(stated, squares) << noise;
    EXPECT_LT(worst, 2.0) << noise;
  }
}

}  // namespace
}  // namespace proofmass::signal
