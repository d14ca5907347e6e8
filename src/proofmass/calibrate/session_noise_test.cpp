#include "proofmass/calibrate/session_noise.hpp"

#include <gtest/gtest.h>

#include "proofmass/calibrate/session_noise_test_support.hpp"
#include "proofmass/calibrate/slow_noise.hpp"

namespace proofmass::calibrate::session_noise_test {
namespace {

// A random walk with increments of variance 3 per unit of time, summed step by step.
TEST(SlowNoiseCovariance, OfARandomWalkIsThatOfItsSteps) {
  const std::vector<Span> spans{{0.0, 3.0}, {5.0, 7.0}, {11.0, 16.0}};
  constexpr int steps = 16 * 50;
  const auto weight = [](const Span& span, int step) {
    // Fraction of the interval after the step.
    const double at = (step + 0.5) / 50.0;
    return std::clamp((span.end - at) / span.length(), 0.0, 1.0);
  };
  const Span whole{0.0, 16.0};
  const Eigen::MatrixXd C = slow_noise_covariance(spans, whole, SlowNoise::random_walk);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (int step = 0; step < steps; ++step)
        sum += (weight(spans[i], step) - weight(whole, step)) *
               (weight(spans[j], step) - weight(whole, step)) * 3.0 / 50.0;
      EXPECT_NEAR(C(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), sum, 2e-3 * 16.0);
    }
}

// Half the mean square of the difference of adjacent means is the Allan variance.
TEST(SlowNoiseCovariance, HasTheAllanVariancesOfItsUnits) {
  for (const double m : {1.0, 8.0, 300.0}) {
    const std::vector<Span> spans{{0.0, m}, {m, 2.0 * m}};
    for (const auto& [noise, expected] :
         {std::pair{SlowNoise::flicker, 1.0}, {SlowNoise::random_walk, m}}) {
      const Eigen::MatrixXd C = slow_noise_covariance(spans, {0.0, 40.0 * m}, noise);
      EXPECT_NEAR(0.5 * (C(0, 0) + C(1, 1) - 2.0 * C(0, 1)), expected, 1e-9 * expected * 1600.0);
    }
  }
}

// The variance of N adjacent means of flicker noise is N ln N / (2 (N − 1) ln 2) times the Allan
// variance.
// Source: D. W. Allan, Proc. IEEE 54 (1966) 221, equation 19.
TEST(SlowNoiseCovariance, OfFlickerNoiseGrowsAsAllanFound) {
  constexpr int count = 32;
  std::vector<Span> spans;
  for (int k = 0; k < count; ++k) spans.push_back({5.0 * k, 5.0 * (k + 1)});
  const Eigen::MatrixXd C = slow_noise_covariance(spans, {0.0, 5.0 * count}, SlowNoise::flicker);
  const double n = count;
  EXPECT_NEAR(C.trace() / (n - 1.0), n * std::log(n) / (2.0 * (n - 1.0) * std::log(2.0)), 1e-6);
}

void expect_covered(const test::Session& session, int runs) {
  const test::SessionCoverage found = test::coverage_of(session, runs);
  EXPECT_GE(found.fits, runs - 1);
  EXPECT_LE(found.suspects, 1);
  EXPECT_LT(found.largest_z, 5.0);
  for (std::size_t kind = 0; kind < 3; ++kind) {
    EXPECT_GT(found.share(kind), 0.90) << kind;
    EXPECT_LE(found.share(kind), 1.00) << kind;
  }
}

// 89 % if only the noise within rests is used.
TEST(SessionNoise, HoldsABiasThatWalksFromPositionToPosition) {
  expect_covered({.walk_mps2_rts = 1e-3}, 25);
}

TEST(SessionNoise, HoldsFlickerNoise) {
  expect_covered({.flicker_mps2 = 3e-3}, 25);
}

TEST(SessionNoise, IsNullWithoutRests) {
  EXPECT_FALSE(session_noise({}, {}, {.gravity_mps2 = test::g}));
}

}  // namespace
}  // namespace proofmass::calibrate::session_noise_test
