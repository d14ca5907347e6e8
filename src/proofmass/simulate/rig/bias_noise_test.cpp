#include "proofmass/simulate/rig/bias_noise.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace proofmass::simulate::bias_noise_test {
namespace {

/// Allan variance of n adjacent means over tau.
double allan_variance(BiasNoise noise, double tau_s, int n) {
  double sum = 0.0, before = noise.mean_over(tau_s);
  for (int k = 1; k < n; ++k) {
    const double now = noise.mean_over(tau_s);
    sum += 0.5 * (now - before) * (now - before);
    before = now;
  }
  return sum / (n - 1);
}

// IEEE Std 952-1997, annex C: (2 ln2/π) B² at every averaging time.
TEST(BiasNoise, FlickerHasAFlatAllanDeviation) {
  constexpr double B = 3.0;
  for (const double tau_s : {0.3, 3.0, 30.0, 300.0})
    EXPECT_NEAR(allan_variance(BiasNoise({.flicker_mps2 = B}, Random(1, "flicker")), tau_s, 10000),
                2.0 * std::numbers::ln2 * std::numbers::inv_pi * B * B, 0.05 * B * B)
        << tau_s;
}

TEST(BiasNoise, TheWalksAllanVarianceGrowsAsATimeOverThree) {
  constexpr double K = 2.0;
  for (const double tau_s : {0.1, 10.0}) {
    const BiasNoise noise({.walk_mps2_rts = K}, Random(2, "walk"));
    EXPECT_NEAR(allan_variance(noise, tau_s, 10000) / (K * K * tau_s / 3.0), 1.0, 0.05);
  }
}

// The mean over one second computed directly, and as the mean of 40 values.
TEST(BiasNoise, AMeanIsDistributedAsThatOfTheValues) {
  const BiasNoise::Strength strength{.flicker_mps2 = 1.0, .walk_mps2_rts = 0.7};
  BiasNoise whole(strength, Random(3, "whole")), parts(strength, Random(4, "parts"));
  double whole_before = 0.0, parts_before = 0.0, whole_squares = 0.0, parts_squares = 0.0;
  constexpr int seconds = 3000, values = 40;
  for (int second = 0; second < seconds; ++second) {
    const double mean = whole.mean_over(1.0);
    double sum = 0.0;
    for (int k = 0; k < values; ++k) {
      parts.pass(0.5 / values);
      sum += parts.value_mps2();
      parts.pass(0.5 / values);
    }
    if (second > 0) {
      whole_squares += std::pow(mean - whole_before, 2);
      parts_squares += std::pow(sum / values - parts_before, 2);
    }
    whole_before = mean;
    parts_before = sum / values;
  }
  EXPECT_NEAR(whole_squares / parts_squares, 1.0, 0.1);
}

TEST(BiasNoise, WhereThereIsNoneItIsZero) {
  BiasNoise none({}, Random(5, "none"));
  none.pass(3.0);
  EXPECT_EQ(none.value_mps2(), 0.0);
  EXPECT_EQ(none.mean_over(2.0), 0.0);
}

}  // namespace
}  // namespace proofmass::simulate::bias_noise_test
