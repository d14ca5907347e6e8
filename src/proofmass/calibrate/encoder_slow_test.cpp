#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>

#include "proofmass/calibrate/encoder_test_support.hpp"

// Coverage of the 95 % intervals over simulated wheels with imperfections that the fit does not
// model exactly: nonlinear accelerometers, run-out, ripple of the speed, a one-pole filter,
// coloured noise, warm-up, quantisation of both.
namespace proofmass::calibrate::encoder_slow_test {
namespace {

using test::SimulatedEncoder;

struct Scenario {
  std::string name;
  void (*change)(SimulatedEncoder&, std::mt19937_64&);
};

double drawn(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

SimulatedEncoder drawn_wheel(std::mt19937_64& random) {
  constexpr double turn = 2.0 * std::numbers::pi;
  std::normal_distribution<double> normal;
  SimulatedEncoder wheel;
  wheel.eccentricity = drawn(random, 0.001, 0.01);
  wheel.eccentricity_phase = drawn(random, 0.0, turn);
  wheel.warp_rad = drawn(random, 0.0, 0.002);
  wheel.warp_phase = drawn(random, 0.0, turn);
  wheel.third_rad = 2e-4 * normal(random);
  wheel.ripples = {{1, drawn(random, 0.0, 0.02), drawn(random, 0.0, turn)},
                   {2, drawn(random, 0.0, 0.01), drawn(random, 0.0, turn)},
                   {5, drawn(random, 0.0, 0.005), drawn(random, 0.0, turn)}};
  wheel.square_std = 2e-4;
  wheel.runout_m = 30e-6 * std::abs(normal(random));
  wheel.sensors = {{0.1 * normal(random), 0.1 * normal(random), drawn(random, 0.0, turn)}};
  return wheel;
}

struct Coverage {
  std::array<int, 2> components{}, amplitudes{}, phases{};
  std::array<int, 2> named{};  // with an amplitude and a phase
  int count = 0;

  void add(const EncoderCalibration& fit, const SimulatedEncoder& wheel) {
    const test::EncoderTruth truth = test::truth_of(wheel);
    ++count;
    for (std::size_t order = 0; order < 2; ++order) {
      const EncoderHarmonic& one = fit.harmonics[order];
      const double c = truth.errors[2 * order], s = truth.errors[2 * order + 1];
      const double factor = one.half_width_95_rad / std::max(one.cos_rad.std, one.sin_rad.std);
      components[order] += std::abs(one.cos_rad.value - c) < factor * one.cos_rad.std ? 1 : 0;
      components[order] += std::abs(one.sin_rad.value - s) < factor * one.sin_rad.std ? 1 : 0;
      if (!one.amplitude_rad) continue;
      ++named[order];
      const double amplitude = std::hypot(c, s);
      amplitudes[order] +=
          amplitude > one.amplitude_95_rad[0] && amplitude < one.amplitude_95_rad[1] ? 1 : 0;
      const double off =
          std::remainder(std::atan2(-s, c) - one.phase_rad->value, 2.0 * std::numbers::pi);
      phases[order] += std::abs(off) < (*one.phase_95_rad)[1] - one.phase_rad->value ? 1 : 0;
    }
  }
};

class EncoderCoverage : public testing::TestWithParam<Scenario> {};

TEST_P(EncoderCoverage, IsThatStated) {
  std::mt19937_64 random(20261125);
  Coverage coverage;
  for (int run = 0; run < 100; ++run) {
    SimulatedEncoder wheel = drawn_wheel(random);
    GetParam().change(wheel, random);
    const auto fit = calibrate_encoder(test::simulate(wheel, random));
    ASSERT_TRUE(fit) << fit.error().message;
    coverage.add(*fit, wheel);
  }
  for (std::size_t order = 0; order < 2; ++order) {
    // 93 to 99 % of 200 components, with three standard deviations of the count below.
    EXPECT_GE(coverage.components[order], 182) << GetParam().name << ", order " << order + 1;
    if (coverage.named[order] < 50) continue;
    EXPECT_GE(coverage.amplitudes[order], 0.89 * coverage.named[order]) << GetParam().name;
    EXPECT_GE(coverage.phases[order], 0.89 * coverage.named[order]) << GetParam().name;
  }
  const auto share = [&](int inside, int of) { return std::to_string(100.0 * inside / of); };
  RecordProperty("once", share(coverage.components[0], 200));
  RecordProperty("twice", share(coverage.components[1], 200));
}

INSTANTIATE_TEST_SUITE_P(
    Wheels,
    EncoderCoverage,
    testing::Values(Scenario{"one speed", [](SimulatedEncoder&, std::mt19937_64&) {}},
                    Scenario{"two speeds",
                             [](SimulatedEncoder& wheel, std::mt19937_64&) {
                               wheel.speed_radps = [](double time_s) {
                                 return 1.152 + 1.048 * std::clamp((time_s - 60.0) / 3.0, 0.0, 1.0);
                               };
                             }},
                    Scenario{"missed counts",
                             [](SimulatedEncoder& wheel, std::mt19937_64& random) {
                               wheel.missed = {{drawn(random, 20.0, 50.0), 1.0}, {80.0, -3.0}};
                             }},
                    Scenario{"stamped edges",
                             [](SimulatedEncoder& wheel, std::mt19937_64&) {
                               wheel.edges = true;
                               wheel.counts_per_turn = 512;
                             }},
                    Scenario{"a minute, 1024 counts",
                             [](SimulatedEncoder& wheel, std::mt19937_64&) {
                               wheel.seconds = 60.0;
                               wheel.counts_per_turn = 1024;
                             }},
                    Scenario{"two sensors", [](SimulatedEncoder& wheel, std::mt19937_64&) {
                               wheel.sensors.push_back(
                                   {-wheel.sensors[0][0], -wheel.sensors[0][1], 1.0});
                             }}));

}  // namespace
}  // namespace proofmass::calibrate::encoder_slow_test
