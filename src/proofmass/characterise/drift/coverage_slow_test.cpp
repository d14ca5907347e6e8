#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <random>
#include <string>

#include "proofmass/characterise/drift/drift_test_support.hpp"
#include "proofmass/characterise/drift/fit.hpp"

// Coverage of the intervals of the warm-up, and rate of false warm-ups: hundreds of recordings of 2
// h at 1 Hz, in mg, as means over 4 s.
namespace proofmass::characterise::drift_coverage_slow_test {
namespace {

using test::Series;

constexpr std::size_t samples = 7200;
constexpr double rate_hz = 1.0;
constexpr double a1 = 5.0, time_constant_s = 900.0, a2 = 1.5;

DriftFit fitted(const Series& series) {
  return fit_drift(test::evidence_of(series, {rate_hz, 4})).fit;
}

/// The record for a seed; seeds that differ by three are independent.
using Source = std::function<Series(unsigned seed)>;

Series white(unsigned seed) {
  return test::white(1.0, rate_hz, samples, seed);
}

/// Two standard deviations of a fraction p of that many trials.
double allowance(double p, int trials) {
  return 2.0 * std::sqrt(p * (1.0 - p) / trials);
}

struct Tally {
  int identified = 0, undetermined = 0, of_a1 = 0, of_time = 0, of_a2 = 0;
};

int holds(const std::optional<Interval95>& interval, double truth) {
  return interval && interval->lower_95.value_or(-HUGE_VAL) <= truth &&
                 truth <= interval->upper_95.value_or(HUGE_VAL)
             ? 1
             : 0;
}

/// Nominal coverage is 95 %: 92 to 98 % plus two standard deviations of the number of trials is
/// accepted, which is 88.2 to 99.98 % for 200.
void expect_share(int count, int trials, const char* of) {
  const double share = static_cast<double>(count) / trials;
  testing::Test::RecordProperty(of, std::to_string(share));
  EXPECT_GE(share, 0.92 - allowance(0.92, trials)) << of;
  EXPECT_LE(share, 0.98 + allowance(0.98, trials)) << of;
}

// Under a random walk a hyperbola may fit as well.
void expect_covered(const Source& noise, double least_identified) {
  constexpr int runs = 200;
  const Series curve = test::sum_of(
      {test::warm_up(a1, time_constant_s, rate_hz, samples), test::level(a2, samples)});
  Tally tally;
  for (unsigned run = 0; run < runs; ++run) {
    const DriftFit fit = fitted(test::sum_of({curve, noise(1000 + 3 * run)}));
    tally.undetermined += fit.why == DriftReason::shape_undetermined ? 1 : 0;
    if (!fit.identified) continue;
    ++tally.identified;
    tally.of_a1 += holds(fit.a1, a1);
    tally.of_time += holds(fit.time_constant_s, time_constant_s);
    tally.of_a2 += holds(fit.a2, a2);
  }
  testing::Test::RecordProperty("identified", tally.identified);
  testing::Test::RecordProperty("undetermined", tally.undetermined);
  EXPECT_GE(tally.identified + tally.undetermined, 0.95 * runs);
  EXPECT_GE(tally.identified, least_identified * runs);
  expect_share(tally.of_a1, tally.identified, "a1");
  expect_share(tally.of_time, tally.identified, "T");
  expect_share(tally.of_a2, tally.identified, "a2");
}

void expect_seldom_identified(const Source& record) {
  constexpr int runs = 100;
  int identified = 0;
  std::map<DriftReason, int> why;
  for (unsigned run = 0; run < runs; ++run) {
    const DriftFit fit = fitted(record(1000 + 3 * run));
    identified += fit.identified ? 1 : 0;
    ++why[fit.why];
  }
  testing::Test::RecordProperty("identified", identified);
  std::string reasons;
  for (const auto& [reason, count] : why)
    reasons += std::to_string(static_cast<int>(reason)) + ": " + std::to_string(count) + " ";
  testing::Test::RecordProperty("why", reasons);
  EXPECT_LE(identified, 0.05 * runs);
}

TEST(DriftCoverage, InWhiteNoise) {
  expect_covered(white, 0.95);
}

TEST(DriftCoverage, InWhiteNoiseAndARandomWalk) {
  expect_covered(
      [](unsigned seed) {
        return test::sum_of({white(seed), test::random_walk(0.005, rate_hz, samples, seed + 1)});
      },
      0.65);
}

TEST(DriftCoverage, InWhiteNoiseAndMarkovNoise) {
  constexpr double std = 0.3, relaxation_s = 60.0;
  expect_covered(
      [](unsigned seed) {
        return test::sum_of({white(seed), test::markov(std * std::sqrt(2.0 / relaxation_s),
                                                       relaxation_s, rate_hz, samples, seed + 1)});
      },
      0.65);
}

TEST(DriftCoverage, SeldomSeesAWarmUpInARandomWalk) {
  expect_seldom_identified([](unsigned seed) {
    return test::sum_of({white(seed), test::random_walk(0.02, rate_hz, samples, seed + 1)});
  });
}

/// Four steps of 2 to 4 mg, up or down, anywhere.
TEST(DriftCoverage, SeldomSeesAWarmUpInSteps) {
  expect_seldom_identified([](unsigned seed) {
    std::mt19937_64 random(seed);
    Series series = white(seed + 1);
    for (int step = 0; step < 4; ++step) {
      const double size = std::uniform_real_distribution(2.0, 4.0)(random);
      const double sign = std::bernoulli_distribution(0.5)(random) ? 1.0 : -1.0;
      const auto from = std::uniform_int_distribution<std::size_t>(100, samples - 100)(random);
      series = test::sum_of({series, test::step_at(from, sign * size, samples)});
    }
    return series;
  });
}

TEST(DriftCoverage, SeldomSeesAWarmUpInAStraightLine) {
  expect_seldom_identified([](unsigned seed) {
    return test::sum_of(
        {white(seed), test::ramp(3.0 / static_cast<double>(samples), 1.0, samples)});
  });
}

// --- other shapes --------------------------------------------------------------------------------

/// A curve as a function of the fraction of the recording, with a total change of some 5 mg; its
/// forecast is tested at 1.5 times the duration.
struct OtherCurve {
  const char* name;
  double (*of_share)(double share);
};

// Sines of one, a half and a quarter period, and the other four shapes.
constexpr std::array<OtherCurve, 7> other_curves{
    {{"square root", [](double u) { return 5.0 * std::sqrt(u); }},
     {"logarithm", [](double u) { return 5.0 * std::log1p(60.0 * u) / std::log(61.0); }},
     {"hyperbola", [](double u) { return 5.0 * u / (u + 0.11); }},
     {"stretched exponential", [](double u) { return -5.0 * std::expm1(-std::sqrt(u / 0.11)); }},
     {"one period", [](double u) { return 2.5 * std::sin(6.283185307 * u); }},
     {"half a period", [](double u) { return 2.5 * std::sin(3.141592654 * u); }},
     {"a quarter", [](double u) { return 5.0 * std::sin(1.570796327 * u); }}}};

void expect_no_exponential(const OtherCurve& other, int runs) {
  int identified = 0, forecasts = 0, held = 0;
  for (unsigned run = 0; run < static_cast<unsigned>(runs); ++run) {
    Series series = white(5000 + 3 * run);
    for (std::size_t k = 0; k < samples; ++k)
      series[k] += other.of_share((static_cast<double>(k) + 0.5) / samples);
    const DriftFit fit = fitted(series);
    identified += fit.identified ? 1 : 0;
    constexpr double later = 1.5;
    const auto found = forecast(fit, later * samples / rate_hz);
    if (!found) continue;
    ++forecasts;
    held += holds(found->bias, other.of_share(later));
  }
  const std::string name(other.name);
  testing::Test::RecordProperty(name + ": identified", identified);
  testing::Test::RecordProperty(name + ": forecasts", forecasts);
  testing::Test::RecordProperty(name + ": held", held);
  EXPECT_LE(identified, 0.05 * runs) << other.name;
  if (forecasts == 0) return;
  EXPECT_GE(held, (0.93 - allowance(0.93, forecasts)) * forecasts) << other.name;
}

TEST(DriftCoverage, CallsNoOtherShapeAnExponentialAndForecastsThemAll) {
  constexpr int runs = 100;
  for (const OtherCurve& other : other_curves) expect_no_exponential(other, runs);
}

}  // namespace
}  // namespace proofmass::characterise::drift_coverage_slow_test
