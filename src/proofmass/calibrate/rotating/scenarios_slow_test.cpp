#include <algorithm>
#include <array>
#include <cstdio>
#include <gtest/gtest.h>
#include <optional>
#include <string>

#include "proofmass/calibrate/rotation_test_support.hpp"

// Coverage of the 95 % intervals for realistic wheels: speed ripple, a radius that one speed does
// not determine, a filter in the sensor.
namespace proofmass::calibrate::rotation_scenarios_slow_test {
namespace {

using Q = RotationQuantity;
constexpr int tests = 100;

/// Uniform distribution.
struct Range {
  double low = 0.0, high = 0.0;
  [[nodiscard]] double draw(std::mt19937& random) const {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
};

struct Scenario {
  const char* name;
  std::array<Range, 3> ripple{};  ///< of the speed, at one to three times per turn
  Range radius_m{0.02, 0.2};
  std::size_t axes = 2, speeds = 1;
  bool encoder = false;
  double speed_drift = 0.0;  ///< relative amplitude of a slow sine in the speed
  double pole_hz = 0.0;      ///< bandwidth of the sensor's filter; 0: none
};

/// Truth of one test.
struct Bench {
  std::vector<sensor::ModelEquation> equations;
  std::vector<RotationRecording> recordings;
  double radius_m = 0.0;
};

/// A one-pole filter, sampled, exact for piecewise linear inputs.
void filter(std::vector<double>& x, double pole_hz, double rate_hz) {
  const double tau = 1.0 / (rad_per_turn * pole_hz), h = 1.0 / rate_hz, a = std::exp(-h / tau);
  double state = x.front(), before = x.front();
  for (double& now : x) {
    const double slope = (now - before) / h, input = now;
    state = a * state + (1.0 - a) * before + slope * (h - tau * (1.0 - a));
    before = input;
    now = state;
  }
}

RotationRecording recording(const Scenario& scenario,
                            const Bench& bench,
                            double mounting_rad,
                            double speed,
                            std::mt19937& random) {
  PlainWheel wheel;
  wheel.equations = bench.equations;
  wheel.radius_m = bench.radius_m;
  wheel.mounting_rad = mounting_rad;
  wheel.give_angle = scenario.encoder;
  std::array<double, 3> size{}, phase{};
  for (std::size_t n = 0; n < 3; ++n) {
    size[n] = scenario.ripple[n].draw(random);
    phase[n] = Range{0.0, rad_per_turn}.draw(random);
  }
  const double slow_phase = Range{0.0, rad_per_turn}.draw(random);
  const double slow_radps = rad_per_turn / Range{40.0, 150.0}.draw(random);
  wheel.angle = [=](double t) {
    double theta = speed * t + 0.7;
    theta += scenario.speed_drift * speed / slow_radps * std::sin(slow_radps * t + slow_phase);
    for (int n = 1; n <= 3; ++n) {
      const auto k = static_cast<std::size_t>(n - 1);
      theta += size[k] / n * std::sin(n * speed * t + phase[k]);
    }
    return theta;
  };
  RotationRecording read = turned(wheel);
  std::normal_distribution<double> normal;
  for (std::vector<double>& axis : read.axes) {
    if (scenario.pole_hz > 0.0) filter(axis, scenario.pole_hz, wheel.rate_hz);
    for (double& e : axis) e += 0.02 * normal(random);
  }
  return read;
}

Bench draw(const Scenario& scenario, unsigned seed) {
  std::mt19937 random(seed);
  Bench bench;
  const Range tenth{-0.5, 0.5}, scale{0.97, 1.03}, angle{-0.02, 0.02};
  for (std::size_t k = 0; k < scenario.axes; ++k)
    bench.equations.push_back({.K1 = scale.draw(random),
                               .K0 = tenth.draw(random),
                               .delta_o = k + 1 == scenario.axes ? angle.draw(random) : 0.0});
  bench.radius_m = scenario.radius_m.draw(random);
  // With an encoder, a mounting angle other than a multiple of 90° would be a misalignment.
  const double mounting_rad = scenario.encoder ? 0.0 : Range{0.0, rad_per_turn}.draw(random);
  const Range rpm = scenario.speeds > 1 ? Range{8.0, 14.0} : Range{8.0, 30.0};
  const double speed = rpm.draw(random) * radps_per_rpm;
  for (std::size_t k = 0; k < scenario.speeds; ++k)
    bench.recordings.push_back(
        recording(scenario, bench, mounting_rad, speed * (1.0 + static_cast<double>(k)), random));
  return bench;
}

struct Tally {
  int inside = 0, given = 0;
  double largest_z = 0.0;
  std::vector<double> widths;
};

std::optional<double> truth_of(Q quantity, const sensor::ModelEquation& equation) {
  switch (quantity) {
    case Q::K1:
      return equation.K1;
    case Q::K0:
      return equation.K0;
    case Q::misalignment:
      return equation.delta_o;
    case Q::K2_minus_Kpp:
    case Q::Kip:
    case Q::K3:
      return 0.0;
    default:
      return std::nullopt;
  }
}

void count(const RotationCoefficient& one, double truth, Tally& tally) {
  if (!one.value) return;
  ++tally.given;
  const double error = std::abs(one.value->value - truth);
  if (error < one.half_width_95) ++tally.inside;
  tally.largest_z = std::max(tally.largest_z, error / one.value->std);
  tally.widths.push_back(one.half_width_95);
}

void expect_honest(const char* name, Tally& tally) {
  if (tally.given == 0) return;
  std::ranges::sort(tally.widths);
  const double share = static_cast<double>(tally.inside) / tally.given;
  std::printf("  %-18s %5.3f of %3d, largest z %5.2f, half-width %.3g\n", name, share, tally.given,
              tally.largest_z, tally.widths[tally.widths.size() / 2]);
  EXPECT_GT(share, 0.93 - 2.0 * std::sqrt(0.05 * 0.95 / tally.given)) << name;
  EXPECT_LT(tally.largest_z, 5.0) << name;
}

class RotationScenarios : public testing::TestWithParam<Scenario> {};

TEST_P(RotationScenarios, HoldTheTruth) {
  std::array<Tally, rotation_quantities> tallies;
  Tally radius;
  std::printf("%s\n", GetParam().name);
  for (unsigned seed = 1; seed <= tests; ++seed) {
    const Bench bench = draw(GetParam(), seed);
    const RotationFit fit = fit_of(bench.recordings);
    for (std::size_t axis = 0; axis < fit.axes.size(); ++axis) {
      for (const RotationCoefficient& one : fit.axes[axis].coefficients)
        if (const auto truth = truth_of(one.quantity, bench.equations[axis]))
          count(one, *truth, tallies[static_cast<std::size_t>(one.quantity)]);
    }
    if (fit.axes.size() == 2) count(fit.radius, bench.radius_m, radius);
  }
  for (std::size_t q = 0; q < rotation_quantities; ++q)
    expect_honest(std::string(name_of(static_cast<Q>(q))).c_str(), tallies[q]);
  expect_honest("radius", radius);
}

constexpr Range little{0.001, 0.003}, much{0.006, 0.02}, two{0.02, 0.02}, none{};

INSTANTIATE_TEST_SUITE_P(
    Wheels,
    RotationScenarios,
    testing::Values(
        Scenario{.name = "no ripple"},
        Scenario{.name = "0.1 to 0.3 % at 1, 2, 3", .ripple = {little, little, little}},
        Scenario{.name = "0.6 to 2 % at 1, 2, 3", .ripple = {much, much, much}},
        Scenario{
            .name = "the same, on the axle", .ripple = {much, much, much}, .radius_m = {0.0, 0.0}},
        Scenario{.name = "the same, encoder", .ripple = {much, much, much}, .encoder = true},
        Scenario{.name = "the same, one axis", .ripple = {much, much, much}, .axes = 1},
        Scenario{
            .name = "2 % once, on the axle", .ripple = {two, none, none}, .radius_m = {0.0, 0.0}},
        Scenario{.name = "2 % once", .ripple = {two, none, none}},
        Scenario{.name = "two speeds", .speeds = 2},
        Scenario{
            .name = "two speeds, 0.1 to 0.3 %", .ripple = {little, little, little}, .speeds = 2},
        Scenario{.name = "two speeds, 0.6 to 2 %", .ripple = {much, much, much}, .speeds = 2},
        Scenario{.name = "two speeds, 2 % once", .ripple = {two, none, none}, .speeds = 2},
        Scenario{.name = "two speeds that wander by 0.2 %", .speeds = 2, .speed_drift = 0.002},
        Scenario{.name = "two speeds, encoder",
                 .ripple = {much, much, much},
                 .speeds = 2,
                 .encoder = true},
        Scenario{.name = "two speeds, one axis", .axes = 1, .speeds = 2},
        Scenario{.name = "no ripple, one axis", .axes = 1},
        Scenario{.name = "encoder", .axes = 1, .encoder = true},
        Scenario{.name = "encoder, 50 Hz pole", .encoder = true, .pole_hz = 50.0},
        Scenario{
            .name = "encoder, 50 Hz pole, one axis", .axes = 1, .encoder = true, .pole_hz = 50.0}));

}  // namespace
}  // namespace proofmass::calibrate::rotation_scenarios_slow_test
