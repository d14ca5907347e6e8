#include "proofmass/characterise/stationarity.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

namespace proofmass::characterise::stationarity_test {
namespace {

using test::Series;

constexpr double rate_hz = 100.0;
constexpr std::size_t samples = 20'000;

Stationarity tested(const Series& series, double at_rate_hz = rate_hz) {
  StationarityTest differences;
  differences.add(series);
  return test_stationarity(differences, series, at_rate_hz, {});
}

int alarms(unsigned records, const std::function<Series(unsigned)>& draw) {
  int found = 0;
  for (unsigned seed = 0; seed < records; ++seed)
    found += tested(draw(10 * seed + 1)).stationary ? 0 : 1;
  return found;
}

Series modulated(Series series, const std::function<double(double)>& level) {
  const auto n = static_cast<double>(series.size());
  for (std::size_t k = 0; k < series.size(); ++k) series[k] *= level(static_cast<double>(k) / n);
  return series;
}

Series louder_half(double factor, unsigned seed, std::size_t n = samples) {
  return modulated(test::white(1.0, rate_hz, n, seed),
                   [=](double x) { return x < 0.5 ? 1.0 : factor; });
}

// The false-alarm rate is below 1 %: more than three of 60 records would be improbable.
TEST(Stationarity, IsNotDoubtedOfStationaryNoiseOfAnyColour) {
  EXPECT_LE(alarms(60, [](unsigned s) { return test::white(1.0, rate_hz, samples, s); }), 3);
  EXPECT_LE(alarms(60, [](unsigned s) { return test::random_walk(1.0, rate_hz, samples, s); }), 3);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::flicker(1.0, samples, s); }), 2);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::markov(1.0, 3.0, rate_hz, samples, s); }), 2);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::quantisation(1.0, rate_hz, samples, s); }), 2);
}

// White noise behind poles far below the rate: an earlier test flagged 42 of 100 such records.
Series behind_poles(int poles, double time_constant_s, unsigned seed) {
  const std::size_t past = 10'000;
  Series y = test::normals(samples + past, seed);
  const double decay = std::exp(-1.0 / (time_constant_s * rate_hz));
  for (int pole = 0; pole < poles; ++pole)
    for (std::size_t k = 1; k < y.size(); ++k) y[k] += decay * y[k - 1];
  return {y.begin() + past, y.end()};
}

TEST(Stationarity, IsNotDoubtedBehindAFilterOfSeveralSlowPoles) {
  EXPECT_LE(alarms(60, [](unsigned s) { return behind_poles(3, 3.0, s); }), 6);
  EXPECT_LE(alarms(60, [](unsigned s) { return behind_poles(4, 1.0, s); }), 6);
  EXPECT_LE(alarms(60, [](unsigned s) { return behind_poles(4, 3.0, s); }), 6);
}

TEST(Stationarity, InPiecesIsThatOfTheWhole) {
  const Series y = louder_half(1.3, 3);
  StationarityTest pieces;
  for (std::size_t from = 0, size = 1; from < y.size(); from += size, size = size * 7 % 4093 + 1)
    pieces.add(View<double>(y).subspan(from, std::min(size, y.size() - from)));
  const Stationarity found = pieces.finish(rate_hz, {}), whole = tested(y);
  EXPECT_FALSE(found.stationary);
  EXPECT_EQ(found.p, whole.p);
  EXPECT_EQ(found.relative_level, whole.relative_level);
}

TEST(EqualSpans, AreMeansOfAsManyValuesEachHoweverLongTheSeries) {
  for (const std::size_t n : {100U, 256U, 257U, 1000U, 5000U}) {
    EqualSpans spans;
    for (std::size_t k = 0; k < n; ++k) spans.add(static_cast<double>(k));
    const std::vector<double> means = spans.means();
    ASSERT_EQ(means.size(), n / spans.length());
    ASSERT_LE(means.size(), 256U);
    ASSERT_GE(means.size(), std::min<std::size_t>(n, 128));
    for (std::size_t k = 0; k < means.size(); ++k)
      EXPECT_EQ(means[k],
                static_cast<double>(spans.length()) * (static_cast<double>(k) + 0.5) - 0.5);
  }
}

TEST(EqualSpans, TakenTogetherGoOnWhereTheyAre) {
  EqualSpans spans;
  for (int k = 0; k < 3; ++k) spans.add(k);
  spans.halve();
  EXPECT_EQ(spans.means(), Series{0.5});
  spans.add(std::nan(""));
  EXPECT_EQ(spans.means(), (Series{0.5, 2.0}));
}

TEST(Stationarity, IsNotDoubtedForRoundingOrHeavyTails) {
  EXPECT_LE(alarms(30,
                   [](unsigned s) {
                     Series y = test::normals(samples, s);
                     for (double& value : y) value = std::round(0.5 * value + 0.3);
                     return y;
                   }),
            2);
  EXPECT_LE(alarms(30,
                   [](unsigned s) {  // Student's t with three degrees of freedom
                     Series y = test::normals(samples, s);
                     const Series a = test::normals(samples, s + 1),
                                  b = test::normals(samples, s + 2),
                                  c = test::normals(samples, s + 3);
                     for (std::size_t k = 0; k < y.size(); ++k)
                       y[k] /= std::sqrt((a[k] * a[k] + b[k] * b[k] + c[k] * c[k]) / 3.0);
                     return y;
                   }),
            2);
}

TEST(Stationarity, IsDeniedWhereWhiteNoiseChangesHalfWay) {
  EXPECT_EQ(alarms(20, [](unsigned s) { return louder_half(1.3, s); }), 20);
  EXPECT_EQ(alarms(20, [](unsigned s) { return louder_half(4.0, s); }), 20);
}

TEST(Stationarity, IsDeniedOfASlowModulation) {
  const auto draw = [](unsigned s) {
    return modulated(test::white(1.0, rate_hz, samples, s), [](double x) {
      return 1.0 + 0.6 * std::sin(2.0 * std::numbers::pi * 1.7 * x);
    });
  };
  EXPECT_EQ(alarms(20, draw), 20);
}

TEST(Stationarity, IsDeniedWhereFlickerNoiseBeginsHalfWay) {
  const auto draw = [](unsigned s) {
    return test::sum_of({test::white(1.0, rate_hz, samples, s),
                         modulated(test::flicker(4.0, samples, s + 1),
                                   [](double x) { return x < 0.5 ? 0.0 : 1.0; })});
  };
  EXPECT_GE(alarms(20, draw), 19);
}

TEST(Stationarity, NamesTheLineThatBeginsHalfWay) {
  const Series y = test::sum_of({test::white(1.0, rate_hz, 100'000, 5),
                                 modulated(test::sine(3.0, 7.3, rate_hz, 100'000),
                                           [](double x) { return x < 0.5 ? 0.0 : 1.0; })});
  const auto found = analyse_noise(y, {.rate_hz = rate_hz});
  ASSERT_TRUE(found.has_value());
  ASSERT_FALSE(found->stationarity.stationary);
  ASSERT_TRUE(found->stationarity.line_hz.has_value());
  EXPECT_NEAR(*found->stationarity.line_hz, 7.3, 0.05);
}

TEST(Stationarity, HoldsForASteadyLine) {
  const Series y = test::sum_of(
      {test::white(1.0, rate_hz, 100'000, 6), test::sine(30.0, 1.37, rate_hz, 100'000)});
  EXPECT_TRUE(analyse_noise(y, {.rate_hz = rate_hz}).value().stationarity.stationary);
}

TEST(Stationarity, OfAChangeTheIntervalSpansBothLevels) {
  const auto found = analyse_noise(louder_half(2.2, 9), {.rate_hz = rate_hz});
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->parts.size(), 8U);
  EXPECT_NEAR(found->parts.front().model.white.value, 1.0, 0.1);
  EXPECT_NEAR(found->parts.back().model.white.value, 2.2, 0.2);
  EXPECT_LE(found->model.white.lower_95, 1.0);
  EXPECT_GE(found->model.white.upper_two_sided_95, 2.2);
  ASSERT_FALSE(found->notes.empty());
  EXPECT_EQ(found->notes.front().text.find("not stationary"), 0U);
}

TEST(Stationarity, IsNotTestedOfAFewSamples) {
  EXPECT_FALSE(tested(test::normals(40, 1), 1.0).tested);
  EXPECT_TRUE(tested(test::normals(400, 1), 1.0).tested);
}

}  // namespace
}  // namespace proofmass::characterise::stationarity_test
