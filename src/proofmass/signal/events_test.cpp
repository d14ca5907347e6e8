#include "proofmass/signal/events.hpp"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

namespace proofmass::signal::events_test {
namespace {

using Series = std::vector<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double rate_hz = 100.0;

/// Noise generators with the same numbers on every platform.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}

  double uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }
  double normal() {  // a sum of twelve uniforms would cut the tails; Box and Muller's method does
                     // not
    return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
  }
  std::size_t below(std::size_t end) { return engine_() % end; }

  Series white(std::size_t size) {
    Series series(size);
    for (double& x : series) x = normal();
    return series;
  }
  Series walk(std::size_t size, double step) {
    Series series = white(size);
    double sum = 0.0;
    for (double& x : series) x = sum += step * x;
    return series;
  }
  /// Approximately 1/f over the octaves of 1 … 2^12 samples.
  Series flicker(std::size_t size) {
    Series series(size, 0.0);
    for (double tau = 1.0; tau < 5000.0; tau *= 4.0) {
      const double a = std::exp(-1.0 / tau);
      double state = normal();
      for (double& x : series) x += state = a * state + std::sqrt(1.0 - a * a) * normal();
    }
    return series;
  }
  Series laplace(std::size_t size) {
    Series series(size);
    for (double& x : series) x = (uniform() < 0.5 ? 1.0 : -1.0) * std::log(uniform());
    return series;
  }
  Series line(std::size_t size, double amplitude, double frequency_hz) {
    Series series = white(size);
    const double phase = 2.0 * std::numbers::pi * uniform();
    const double turn = 2.0 * std::numbers::pi * frequency_hz / rate_hz;
    for (std::size_t k = 0; k < size; ++k)
      series[k] += amplitude * std::sin(phase + turn * static_cast<double>(k));
    return series;
  }
  /// A resonance of quality Q driven by white noise, plus white noise.
  Series hump(std::size_t size, double rms, double frequency_hz, double quality) {
    const double turn = 2.0 * std::numbers::pi * frequency_hz / rate_hz;
    const double r = std::exp(-0.5 * turn / quality);
    Series series(size);
    double re = normal();
    double im = normal();
    const double drive = std::sqrt(1.0 - r * r);
    for (double& x : series) {
      const double turned = r * (re * std::cos(turn) - im * std::sin(turn));
      im = r * (re * std::sin(turn) + im * std::cos(turn)) + drive * normal();
      re = turned + drive * normal();
      x = rms * re + normal();
    }
    return series;
  }

 private:
  std::mt19937_64 engine_;
};

Series sum(Series a, const Series& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
  return a;
}

Series rounded(Series series, double quantum) {
  for (double& x : series) x = quantum * std::round(x / quantum);
  return series;
}

Series raised_from(Series series, std::size_t first, double size) {
  for (std::size_t k = first; k < series.size(); ++k) series[k] += size;
  return series;
}

std::vector<Event> events_of(View<double> series) {
  return find_events(series, {.rate_hz = rate_hz});
}

void expect_one(const std::vector<Event>& events,
                EventKind kind,
                std::size_t at,
                std::size_t within) {
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, kind);
  EXPECT_LE(events[0].first, at + within);
  EXPECT_GE(events[0].last + within, at);
  EXPECT_LE(events[0].last - events[0].first, 2 * within + 2);
}

template <class Make>
int records_with_events(int records, Make make) {
  int count = 0;
  for (int record = 0; record < records; ++record) {
    Noise noise(1000 + static_cast<std::uint64_t>(record));
    if (!events_of(make(noise)).empty()) ++count;
  }
  return count;
}

TEST(Events, AreSeenInFewerThanOneInAHundredRecordsOfWhiteNoise) {
  EXPECT_LE(records_with_events(300, [](Noise& noise) { return noise.white(10'000); }), 2);
  EXPECT_LE(records_with_events(500, [](Noise& noise) { return noise.white(1'000); }), 4);
}

TEST(Events, AreNotSeenInLongRecordsOfNoise) {
  Noise noise(4);
  EXPECT_TRUE(events_of(noise.white(1'000'000)).empty());
  EXPECT_TRUE(events_of(noise.walk(1'000'000, 1.0)).empty());
}

TEST(Events, AreNotSeenInRandomWalkAndFlicker) {
  EXPECT_LE(records_with_events(40, [](Noise& n) { return n.walk(10'000, 1.0); }), 1);
  EXPECT_LE(
      records_with_events(40, [](Noise& n) { return sum(n.white(10'000), n.walk(10'000, 0.02)); }),
      1);
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.flicker(10'000); }), 1);
}

TEST(Events, AreNotSeenInLinesAndResonances) {
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.line(10'000, 5.0, 0.5); }), 1);
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.line(10'000, 50.0, 0.562); }), 1);
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.line(10'000, 5.0, 9.7); }), 1);
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.hump(10'000, 3.0, 10.0, 30.0); }), 1);
  EXPECT_LE(records_with_events(20, [](Noise& n) { return n.hump(10'000, 3.0, 0.5, 5.0); }), 1);
}

TEST(Events, AreRareInNoiseWithHeavyTails) {
  EXPECT_LE(records_with_events(100, [](Noise& n) { return n.laplace(10'000); }), 6);
}

TEST(Events, AreNotSeenInAWarmUp) {
  for (const double time_constant : {500.0, 6'000.0, 20'000.0})
    EXPECT_LE(records_with_events(20,
                                  [&](Noise& noise) {
                                    Series series = noise.white(20'000);
                                    for (std::size_t k = 0; k < series.size(); ++k)
                                      series[k] +=
                                          30.0 * std::exp(-static_cast<double>(k) / time_constant);
                                    return series;
                                  }),
              1)
        << time_constant;
}

TEST(Events, AreNotSeenInCoarselyQuantisedNoise) {
  for (const double quantum : {1.0, 2.0, 4.0, 10.0}) {
    EXPECT_LE(records_with_events(20, [&](Noise& n) { return rounded(n.white(10'000), quantum); }),
              1)
        << quantum;
    EXPECT_LE(
        records_with_events(20, [&](Noise& n) { return rounded(n.walk(10'000, 0.1), quantum); }), 1)
        << quantum;
  }
}

TEST(Events, NeedData) {
  EXPECT_TRUE(events_of(Series{}).empty());
  EXPECT_TRUE(events_of(Series{1.0, 5.0, 1.0}).empty());
  EXPECT_TRUE(events_of(Series(5'000, 9.81)).empty());
  EXPECT_TRUE(events_of(Series(5'000, nan)).empty());
  EXPECT_TRUE(events_of(Series(5'000, std::numeric_limits<double>::infinity())).empty());
}

TEST(Outlier, OfTwelveSigmaForOneSampleIsFound) {
  int missed = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Noise noise(seed);
    Series series = noise.white(10'000);
    const std::size_t at = noise.below(series.size());
    series[at] += 12.0;
    const auto events = events_of(series);
    if (events.size() != 1 || events[0].first > at || events[0].last < at) ++missed;
  }
  EXPECT_LE(missed, 1);
}

TEST(Outlier, HasItsPlaceAndSize) {
  for (const std::size_t at : {0u, 1u, 4'000u, 9'998u, 9'999u}) {
    Noise noise(7);
    Series series = noise.white(10'000);
    series[at] = -40.0;
    const auto events = events_of(series);
    expect_one(events, EventKind::outlier, at, 8);
    EXPECT_NEAR(events[0].size, -40.0, 0.5);
    // The level is less certain at an end.
    const double gain = at == 0 || at == 9'999 ? std::sqrt(2.5) : std::sqrt(1.25);
    EXPECT_NEAR(events[0].significance, 40.0 / gain, 4.0) << at;
  }
}

TEST(Outlier, IsFoundAsABurstOfFiveSigmaForAFifthOfASecond) {
  int missed = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Noise noise(seed);
    Series series = noise.white(10'000);
    const std::size_t first = noise.below(series.size() - 20);
    for (std::size_t k = 0; k < 20; ++k) series[first + k] += 5.0 * noise.normal();
    const auto events = events_of(series);
    if (events.size() != 1 || events[0].kind != EventKind::outlier ||
        events[0].first + 10 < first || events[0].last > first + 30)
      ++missed;
  }
  EXPECT_LE(missed, 3);
}

TEST(Outlier, IsFoundAsALeanOfTwoSeconds) {
  Noise noise(8);
  const Series series = raised_from(raised_from(noise.white(10'000), 5'000, 4.0), 5'200, -4.0);
  const auto events = events_of(series);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::outlier);
  EXPECT_NEAR(static_cast<double>(events[0].first), 5'000.0, 20.0);
  EXPECT_NEAR(static_cast<double>(events[0].last), 5'200.0, 20.0);
}

TEST(Outliers, AreSeparated) {
  Noise noise(9);
  Series series = noise.white(20'000);
  for (std::size_t k = 1; k <= 9; ++k) series[2'000 * k] += k % 2 == 0 ? 20.0 : -1e6;
  const auto events = events_of(series);
  ASSERT_EQ(events.size(), 9u);
  for (std::size_t k = 1; k <= 9; ++k) {
    EXPECT_EQ(events[k - 1].kind, EventKind::outlier);
    EXPECT_NEAR(static_cast<double>(events[k - 1].first), static_cast<double>(2'000 * k), 8.0);
    EXPECT_NEAR(events[k - 1].size, k % 2 == 0 ? 20.0 : -1e6, 3.0);
  }
}

TEST(Outlier, IsFoundOnARandomWalkAndOnSway) {
  Noise noise(10);
  Series walk = sum(noise.white(10'000), noise.walk(10'000, 0.1));
  walk[3'000] += 15.0;
  expect_one(events_of(walk), EventKind::outlier, 3'000, 8);
  Series sway = noise.line(10'000, 5.0, 0.5);
  sway[3'000] += 15.0;
  expect_one(events_of(sway), EventKind::outlier, 3'000, 8);
}

TEST(Outlier, IsJudgedByTheNoiseAboutIt) {
  Noise noise(11);
  Series series = noise.white(60'000);
  for (std::size_t k = 45'000; k < series.size(); ++k) series[k] *= 20.0;
  EXPECT_TRUE(events_of(series).empty());
  series[10'000] += 15.0;
  expect_one(events_of(series), EventKind::outlier, 10'000, 8);
}

TEST(Step, OfSixSigmaIsFoundWithItsPlaceAndSize) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Noise noise(seed);
    const std::size_t at = 200 + noise.below(9'600);
    const double size = seed % 2 == 0 ? 6.0 : -300.0;
    const auto events = events_of(raised_from(noise.white(10'000), at, size));
    expect_one(events, EventKind::step, at, 5);
    EXPECT_NEAR(events[0].size, size, 0.5);
  }
}

TEST(Step, OfOneSigmaIsFoundWhereTheRecordIsFlat) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Noise noise(seed);
    const auto events = events_of(raised_from(noise.white(30'000), 11'000, 1.0));
    if (events.size() == 1 && events[0].kind == EventKind::step &&
        std::abs(static_cast<double>(events[0].first) - 11'000.0) < 50.0 &&
        std::abs(events[0].size - 1.0) < 0.3)
      ++found;
  }
  EXPECT_GE(found, 47);
}

TEST(Step, TakesTheOutlierThatMadeItAlong) {
  Noise noise(12);
  Series series = raised_from(noise.white(20'000), 9'000, 8.0);
  for (std::size_t k = 8'990; k < 9'010; ++k) series[k] += 60.0 * noise.normal();
  const auto events = events_of(series);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, EventKind::step);
  EXPECT_NEAR(static_cast<double>(events[0].first), 8'990.0, 10.0);
  EXPECT_NEAR(static_cast<double>(events[0].last), 9'010.0, 10.0);
  EXPECT_NEAR(events[0].size, 8.0, 0.5);
}

TEST(Step, IsFoundBesideAGap) {
  for (const std::size_t at : {8'000u, 8'100u, 8'150u}) {
    Noise noise(13);
    Series series = raised_from(noise.white(60'000), at, 6.0);
    for (std::size_t k = 8'000; k < 8'100; ++k) series[k] = nan;
    const auto events = events_of(series);
    ASSERT_EQ(events.size(), 1u) << at;
    EXPECT_EQ(events[0].kind, EventKind::step);
    EXPECT_GE(events[0].first, 7'990u);
    EXPECT_LE(events[0].first, 8'155u);
    EXPECT_NEAR(events[0].size, 6.0, 0.5);
  }
}

TEST(Steps, AreToldApart) {
  Noise noise(14);
  const Series series = raised_from(raised_from(noise.white(30'000), 9'000, 10.0), 20'000, -4.0);
  const auto events = events_of(series);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(events[0].size, 10.0, 0.5);
  EXPECT_NEAR(events[1].size, -4.0, 0.5);
}

TEST(Events, AreNotTheGapsOfALine) {
  EXPECT_LE(records_with_events(20,
                                [](Noise& noise) {
                                  Series series = noise.line(10'000, 5.0, 0.5);
                                  for (std::size_t k = 900; k < 9'000; ++k)
                                    if (k % 1'700 < 130) series[k] = nan;
                                  return series;
                                }),
            1);
}

TEST(Events, AreNotTheRunsOfAStuckOrClippedSensor) {
  Noise noise(15);
  Series stuck = noise.white(20'000);
  for (std::size_t k = 5'000; k < 6'000; ++k) stuck[k] = stuck[4'999];
  EXPECT_TRUE(events_of(stuck).empty());
  Series clipped = noise.white(20'000);
  for (std::size_t k = 5'000; k < 6'000; ++k) clipped[k] = 30.0;
  EXPECT_TRUE(events_of(clipped).empty());
}

/// Noise whose level and strength jump, with huge values and gaps for some seeds.
Series wild_series(std::uint64_t seed) {
  Noise noise(seed);
  Series series = noise.white(16 + noise.below(6'000));
  double level = 0.0;
  double scale = 1.0;
  for (double& x : series) {
    const double chance = noise.uniform();
    if (chance < 0.01) level += 100.0 * noise.normal();
    if (chance > 0.995) scale = std::exp(3.0 * noise.normal());
    x = level + scale * x;
    if (chance > 0.5 && chance < 0.51) x *= seed % 3 == 0 ? 1e306 : 1e34;
    if (seed % 4 == 0 && chance > 0.2 && chance < 0.4) x = nan;
  }
  return series;
}

TEST(Events, AreAscendingAndApartWhateverTheData) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Series series = wild_series(seed);
    const auto events = events_of(series);
    for (std::size_t k = 0; k < events.size(); ++k) {
      EXPECT_LE(events[k].first, events[k].last);
      EXPECT_LT(events[k].last, series.size());
      EXPECT_TRUE(k == 0 || events[k - 1].last < events[k].first);
      EXPECT_GT(events[k].significance, 0.0);
    }
  }
}

TEST(DropEvents, TakesAMarginOfATenthOfASecondOrTwoSamples) {
  const std::vector<Event> events{{EventKind::outlier, 100, 104, 5.0, 9.0},
                                  {EventKind::step, 198, 198, 5.0, 9.0}};
  Series series(200, 1.0);
  drop_events(series, events, 100.0);
  for (std::size_t k = 0; k < series.size(); ++k)
    EXPECT_EQ(std::isnan(series[k]), (k >= 90 && k <= 114) || k >= 188) << k;
  Series slow(200, 1.0);
  drop_events(slow, events, 1.0);
  for (std::size_t k = 0; k < slow.size(); ++k)
    EXPECT_EQ(std::isnan(slow[k]), (k >= 98 && k <= 106) || k >= 196) << k;
}

TEST(DropEvents, LeavesARecordWithoutEvents) {
  Noise noise(16);
  Series series = noise.white(20'000);
  for (std::size_t k = 6'000; k < 6'050; ++k) series[k] += 30.0 * noise.normal();
  drop_events(series, events_of(series), rate_hz);
  EXPECT_TRUE(events_of(series).empty());
  EXPECT_TRUE(std::isnan(series[6'020]));
  EXPECT_FALSE(std::isnan(series[5'950]));
}

TEST(Events, AnOutlierThatDiesAwaySlowlyIsNoStep) {
  Noise noise(12);
  Series series = noise.white(60'000);
  for (std::size_t k = 0; k < 300; ++k)
    series[30'000 + k] += 150.0 * std::exp(-static_cast<double>(k) / 20.0);
  const auto events = find_events(series, {.rate_hz = 100.0});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, EventKind::outlier);
  EXPECT_NEAR(events[0].size, 150.0, 5.0);
  EXPECT_NEAR(static_cast<double>(events[0].first), 30'000.0, 10.0);
  // 150 σ decay to 1 σ after 100 samples.
  EXPECT_GT(events[0].last, 30'080U);
  EXPECT_LT(events[0].last, 30'200U);
}

}  // namespace
}  // namespace proofmass::signal::events_test
