#include "proofmass/simulate/band_limited_noise.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "proofmass/core/statistics.hpp"

namespace proofmass::simulate::band_limited_noise_test {
namespace {

TEST(BandLimitedNoise, HasItsRmsAndNothingAboveItsBand) {
  const BandLimitedNoise noise(0.5, 10.0, Random(3, "shake"));
  Moments values, steps;
  double before = noise.at(0.0);
  constexpr double dt = 1e-3;
  for (int k = 1; k < 200000; ++k) {
    const double now = noise.at(k * dt);
    values.add(now);
    steps.add((now - before) / dt);
    before = now;
  }
  EXPECT_NEAR(values.std(), 0.5, 0.01);
  // The rms slope of a flat spectrum up to B is 2π B rms / √3.
  EXPECT_NEAR(steps.std(), 0.5 * 2.0 * std::numbers::pi * 10.0 / std::numbers::sqrt3, 0.6);
  for (const auto& c : noise.components())
    EXPECT_LE(c.frequency_radps, 2.0 * std::numbers::pi * 10.0);
  EXPECT_EQ(BandLimitedNoise(0.0, 10.0, Random(3, "shake")).at(1.0), 0.0);
}

}  // namespace
}  // namespace proofmass::simulate::band_limited_noise_test
