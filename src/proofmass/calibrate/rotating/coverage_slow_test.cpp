#include <array>
#include <cstdio>
#include <gtest/gtest.h>

#include "proofmass/calibrate/rotation_test_support.hpp"

// Coverage of the 95 % intervals, by repetition with noise of several colours.
namespace proofmass::calibrate::rotation_coverage_slow_test {
namespace {

using Q = RotationQuantity;
constexpr double g = standard_gravity_mps2;

struct Tally {
  std::array<int, rotation_quantities> inside{}, with{};
};

void count(const RotationAxis& axis, const sensor::ModelEquation& truth, Tally& tally) {
  const std::array<double, rotation_quantities> expected{truth.K1,
                                                         truth.K0 + truth.Kpp * g * g,
                                                         truth.K0 + truth.Kpp * g * g,
                                                         truth.delta_o,
                                                         truth.K2 - truth.Kpp,
                                                         truth.Kip,
                                                         truth.K3,
                                                         0.0};
  for (std::size_t q = 0; q < rotation_quantities; ++q) {
    const RotationCoefficient& one = axis.coefficients[q];
    if (!one.value) continue;
    ++tally.with[q];
    if (std::abs(one.value->value - expected[q]) < one.half_width_95) ++tally.inside[q];
  }
}

// 93 to 97 % plus two standard deviations for the number of runs.
void expect_coverage(const Tally& tally, int runs, double most) {
  const double allowance = 2.0 * std::sqrt(0.05 * 0.95 / runs);
  for (std::size_t q = 0; q < rotation_quantities; ++q) {
    if (tally.with[q] == 0) continue;
    const double share = static_cast<double>(tally.inside[q]) / tally.with[q];
    std::printf("  %-18s %.3f of %d\n", std::string(name_of(static_cast<Q>(q))).c_str(), share,
                tally.with[q]);
    EXPECT_GT(share, 0.93 - allowance) << name_of(static_cast<Q>(q));
    EXPECT_LT(share, most + allowance) << name_of(static_cast<Q>(q));
  }
}

PlainWheel noisy_wheel(unsigned seed) {
  PlainWheel wheel;
  wheel.equations = {{.K1 = 1.0, .K0 = 0.2, .K2 = 8e-5, .Kip = -6e-5}};
  wheel.duration_s = 400.0;
  wheel.rate_hz = 25.0;
  wheel.white = 0.05;
  wheel.seed = seed;
  return wheel;
}

constexpr int runs = 200;
// Noise with a correlation time of half a block makes the intervals too wide, if anything.
constexpr double long_memory_s = 5.0;

double most_for(double memory_s) {
  return memory_s > long_memory_s ? 1.0 : 0.97;
}

class RotationCoverage : public testing::TestWithParam<double> {};

// Markov noise as large as the white noise, with correlation times from a tenth of a second to two
// turns. Without an encoder the intervals allow for a speed ripple, which these wheels do not have.
TEST_P(RotationCoverage, OfOneAxisWithoutAnEncoderIsNinetyFivePerCentOrMore) {
  Tally tally;
  for (unsigned run = 0; run < runs; ++run) {
    PlainWheel wheel = noisy_wheel(run + 1);
    wheel.coloured = GetParam() > 0.0 ? 0.05 : 0.0;
    wheel.memory_s = std::max(GetParam(), 0.01);
    count(fit_of({turned(wheel)}).axes[0], wheel.equations[0], tally);
  }
  expect_coverage(tally, runs, 1.0);
}

TEST_P(RotationCoverage, WithAnEncoderIsNinetyFivePerCent) {
  Tally tally;
  for (unsigned run = 0; run < runs; ++run) {
    PlainWheel wheel = noisy_wheel(run + 1);
    wheel.coloured = GetParam() > 0.0 ? 0.05 : 0.0;
    wheel.memory_s = std::max(GetParam(), 0.01);
    wheel.give_angle = true;
    wheel.equations[0].delta_o = 0.01;
    count(fit_of({turned(wheel)}).axes[0], wheel.equations[0], tally);
  }
  expect_coverage(tally, runs, most_for(GetParam()));
}

TEST_P(RotationCoverage, OfTwoAxesIsNinetyFivePerCentOrMore) {
  Tally first, second;
  for (unsigned run = 0; run < runs; ++run) {
    PlainWheel wheel = noisy_wheel(run + 1);
    wheel.equations = {{.K1 = 1.0, .K0 = 0.2}, {.K1 = 0.97, .K0 = -0.3, .delta_o = 0.01}};
    wheel.coloured = GetParam() > 0.0 ? 0.05 : 0.0;
    wheel.memory_s = std::max(GetParam(), 0.01);
    const RotationFit fit = fit_of({turned(wheel)});
    count(fit.axes[0], wheel.equations[0], first);
    count(fit.axes[1], wheel.equations[1], second);
  }
  expect_coverage(first, runs, 1.0);
  expect_coverage(second, runs, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Memories, RotationCoverage, testing::Values(0.0, 0.1, 1.0, 10.0));

TEST(RotationCoverageOfRadius, AndBiasAtTwoSpeedsIsNinetyFivePerCent) {
  Tally tally;
  int inside = 0;
  for (unsigned run = 0; run < runs; ++run) {
    PlainWheel slow = noisy_wheel(2 * run + 1), fast = noisy_wheel(2 * run + 2);
    slow.radius_m = fast.radius_m = 0.1;
    slow.coloured = fast.coloured = 0.05;
    fast.angle = [](double t) { return 2.2 * t; };
    fast.duration_s = 220.0;
    const RotationFit fit = fit_of({turned(slow), turned(fast)});
    const RotationCoefficient& radius = fit.radius;
    if (radius.value && std::abs(radius.value->value - 0.1) < radius.half_width_95) ++inside;
    const RotationCoefficient& bias = fit.axes[0][Q::K0];
    ++tally.with[1];
    if (std::abs(bias.value.value().value - 0.2) < bias.half_width_95) ++tally.inside[1];
  }
  std::printf("  radius %.3f\n", inside / static_cast<double>(runs));
  EXPECT_NEAR(inside / static_cast<double>(runs), 0.95, 0.02 + 0.018);
  // A ripple that cannot be separated from the sensor's errors enters the bias of a single axis in
  // full.
  expect_coverage(tally, runs, 1.0);
}

}  // namespace
}  // namespace proofmass::calibrate::rotation_coverage_slow_test
