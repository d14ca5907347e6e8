#include "proofmass/estimate/wheel_passes.hpp"

#include <gtest/gtest.h>

#include "proofmass/estimate/wheel_colour.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_passes_test {
namespace {

/// Of an AR(1) sequence of unit driving noise, in blocks much longer than its memory.
double block_ratio(double coefficient) {
  constexpr int blocks = 400, each = 500;
  test::Normal normal(3);
  BlockVariance variance;
  double value = 0.0;
  for (int block = 0; block < blocks; ++block) {
    for (int i = 0; i < each; ++i) variance.add(value = coefficient * value + normal());
    variance.end_block();
  }
  return variance.ratio();
}

// Of an AR(1) sequence the sum over a long block has (1 + a) / (1 − a) times the sum of the
// variances. One standard deviation of the ratio over 400 blocks is 7 %.
TEST(BlockVariance, IsOneOfWhiteScoresAndTheLongRunVarianceOfColouredOnes) {
  EXPECT_NEAR(block_ratio(0.0), 1.0, 0.25);
  EXPECT_NEAR(block_ratio(0.8), 9.0, 2.3);
}

TEST(BlockVariance, OfWhatCancelsIsNoGain) {
  EXPECT_EQ(block_ratio(-0.8), 1.0);
  EXPECT_EQ(BlockVariance{}.ratio(), 1.0);
}

/// A path that speeds up evenly from `from_radps` to `to_radps` within ten seconds, at 100 Hz.
struct Ramp {
  WheelPath path;
  std::vector<double> time_s;
  double accel_radps2;

  Ramp(double from_radps, double to_radps) : accel_radps2((to_radps - from_radps) / 10.0) {
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.01 * k;
      time_s.push_back(t);
      path.moving.emplace_back(0.0, from_radps + accel_radps2 * t, accel_radps2, 0.0);
    }
  }
};

TEST(WheelLevers, OfASteadyWheelAreItsSquaredSpeedAndNoAcceleration) {
  const Ramp steady(20.0, 20.0);
  for (const Mat<2>& lever : levers_of(steady.path, steady.time_s)) {
    EXPECT_DOUBLE_EQ(lever(0), 400.0);
    EXPECT_EQ(lever(1), 0.0);
  }
}

// The mean of (ω + α t)² over a window that lies evenly about an instant is ω² + α² h² / 3; with a
// row more on one side it moves by ω α times a step.
TEST(WheelLevers, OfARampAreMeansOverTheTurnAboutEachInstant) {
  const Ramp ramp(10.0, 30.0);
  const WheelLevers levers = levers_of(ramp.path, ramp.time_s);
  for (std::size_t k = 0; k < levers.size(); ++k) {
    const double w = ramp.path.moving[k](wheel::speed);
    const double half_s = 0.5 * rad_per_turn / w + 0.01;
    const double bound =
        std::pow(ramp.accel_radps2 * half_s, 2) / 3.0 + w * ramp.accel_radps2 * 0.01;
    EXPECT_NEAR(levers[k](0), w * w, bound);
    EXPECT_NEAR(levers[k](1), ramp.accel_radps2, 1e-9);
  }
}

}  // namespace
}  // namespace proofmass::estimate::wheel_passes_test
