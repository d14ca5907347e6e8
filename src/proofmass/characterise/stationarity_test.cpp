#include "proofmass/characterise/stationarity.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/characterise/noise_test_support.hpp"

namespace proofmass::characterise::stationarity_test {
namespace {

using test::Series;

constexpr double rate_hz = 100.0;
constexpr std::size_t samples = 20'000;

int alarms(unsigned records, const std::function<Series(unsigned)>& draw) {
  int found = 0;
  for (unsigned seed = 0; seed < records; ++seed)
    found += test_stationarity(draw(10 * seed + 1), rate_hz, {}).stationary ? 0 : 1;
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

// Less than one alarm in a hundred: of 60 records more than three would be improbable.
TEST(Stationarity, IsNotDoubtedOfStationaryNoiseOfAnyColour) {
  EXPECT_LE(alarms(60, [](unsigned s) { return test::white(1.0, rate_hz, samples, s); }), 3);
  EXPECT_LE(alarms(60, [](unsigned s) { return test::random_walk(1.0, rate_hz, samples, s); }), 3);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::flicker(1.0, samples, s); }), 2);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::markov(1.0, 3.0, rate_hz, samples, s); }), 2);
  EXPECT_LE(alarms(30, [](unsigned s) { return test::quantisation(1.0, rate_hz, samples, s); }), 2);
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
  EXPECT_FALSE(test_stationarity(test::normals(40, 1), 1.0, {}).tested);
  EXPECT_TRUE(test_stationarity(test::normals(400, 1), 1.0, {}).tested);
}

}  // namespace
}  // namespace proofmass::characterise::stationarity_test
