#include "proofmass/characterise/noise_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/test_support.hpp"

namespace proofmass::characterise::noise_analysis_test {
namespace {

using test::Series;
using test::sum_of;

constexpr double rate_hz = 100.0;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

NoiseOptions options_for(Statistic statistic, SeriesKind kind = SeriesKind::rate) {
  NoiseOptions options;
  options.rate_hz = 1.0;
  options.kind = kind;
  options.statistic = statistic;
  return options;
}

NoiseOptions at_rest() {
  NoiseOptions options;
  options.rate_hz = rate_hz;
  return options;
}

NoiseAnalysis analysed(View<double> series, const NoiseOptions& options) {
  return analyse_noise(series, options).value();
}

bool says(const NoiseAnalysis& analysis, const char* words) {
  return std::any_of(analysis.notes.begin(), analysis.notes.end(),
                     [&](const Note& note) { return note.text.find(words) != std::string::npos; });
}

TEST(AnalyseNoise, TakesTheNoiseTypeFromTheGivenSource) {
  const Series phase = test::nbs14_phase();
  NoiseOptions options = options_for(Statistic::oadev, SeriesKind::phase);
  const NoiseAnalysis by_model = analysed(phase, options);
  options.noise_type = NoiseTypeSource::lag1;
  const NoiseAnalysis by_lag1 = analysed(phase, options);
  options.noise_type = NoiseTypeSource::fixed;
  options.alpha = -2;
  const NoiseAnalysis fixed = analysed(phase, options);
  ASSERT_EQ(by_lag1.deviation.points.size(), by_model.deviation.points.size());
  for (std::size_t k = 0; k < by_model.deviation.points.size(); ++k) {
    EXPECT_FALSE(by_model.deviation.points[k].alpha_lag1.has_value());
    EXPECT_EQ(by_lag1.deviation.points[k].alpha_lag1, by_lag1.deviation.points[k].alpha);
    EXPECT_EQ(fixed.deviation.points[k].alpha, -2);
    EXPECT_EQ(fixed.deviation.points[k].value, by_model.deviation.points[k].value);
  }
  EXPECT_LT(fixed.deviation.points[12].edf, by_model.deviation.points[12].edf);
}

TEST(AnalyseNoise, AFixedTypeStopsAtWhatTheStatisticCanTake) {
  NoiseOptions options = options_for(Statistic::oadev);
  options.noise_type = NoiseTypeSource::fixed;
  options.alpha = -4;
  EXPECT_EQ(analysed(test::normals(200, 1), options).deviation.points.front().alpha, -2);
  options.statistic = Statistic::ohdev;
  EXPECT_EQ(analysed(test::normals(200, 1), options).deviation.points.front().alpha, -4);
}

TEST(AnalyseNoise, WiderConfidenceGivesWiderLimits) {
  const Series series = test::normals(1000, 2);
  NoiseOptions options = options_for(Statistic::oadev);
  const DeviationCurve narrow = analysed(series, options).deviation;
  options.confidence = 0.95;
  const DeviationCurve wide = analysed(series, options).deviation;
  EXPECT_EQ(wide.confidence, 0.95);
  for (std::size_t k = 0; k < narrow.points.size(); ++k) {
    EXPECT_LT(wide.points[k].lower, narrow.points[k].lower);
    EXPECT_GT(wide.points[k].upper, narrow.points[k].upper);
  }
}

TEST(AnalyseNoise, OfAFewSamplesGivesACurveButNoModel) {
  for (std::size_t samples = 3; samples <= 15; ++samples) {
    const NoiseAnalysis found = analysed(test::normals(samples, 3), options_for(Statistic::totdev));
    EXPECT_FALSE(found.deviation.points.empty()) << samples;
    EXPECT_EQ(found.model.ordinates, 0U) << samples;
    EXPECT_TRUE(found.spectrum.frequency_hz.empty()) << samples;
    EXPECT_TRUE(says(found, "too short for coefficients")) << samples;
    for (const DeviationPoint& point : found.deviation.points) EXPECT_EQ(point.alpha, 0);
  }
  EXPECT_GT(analysed(test::normals(400, 3), options_for(Statistic::oadev)).model.ordinates, 0U);
}

TEST(AnalyseNoise, TheLevelIsTheMeanAndAffectsNothingElse) {
  const Series noise = test::white(1e-3, rate_hz, 20'000, 4);
  const NoiseAnalysis plain = analysed(noise, at_rest());
  const NoiseAnalysis raised = analysed(sum_of({noise, Series(noise.size(), 9.81)}), at_rest());
  EXPECT_NEAR(raised.mean - 9.81, plain.mean, 1e-12);
  for (std::size_t k = 0; k < plain.deviation.points.size(); ++k)
    EXPECT_NEAR(raised.deviation.points[k].value / plain.deviation.points[k].value, 1.0, 1e-9);
  EXPECT_NEAR(raised.model.white.value / plain.model.white.value, 1.0, 1e-9);
}

TEST(AnalyseNoise, TheModelsCurveRunsThroughTheDeviation) {
  const Series series = sum_of(
      {test::white(1e-3, rate_hz, 100'000, 5), test::random_walk(3e-4, rate_hz, 100'000, 6)});
  const NoiseAnalysis found = analysed(series, at_rest());
  int outside = 0;
  for (const DeviationPoint& point : found.deviation.points) {
    const double expected = std::sqrt(found.model.allan_variance(point.tau_s));
    outside += expected < point.lower || expected > point.upper ? 1 : 0;
  }
  EXPECT_LT(outside, static_cast<int>(found.deviation.points.size()) / 2);
  EXPECT_EQ(found.deviation.points.front().alpha, 0);
  EXPECT_EQ(found.deviation.points.back().alpha, -2);
}

TEST(AnalyseNoise, OneSampleInAHundredMissingChangesLittle) {
  const Series whole =
      sum_of({test::white(1e-3, rate_hz, 60'000, 7), test::random_walk(5e-4, rate_hz, 60'000, 8)});
  Series holed = whole;
  const Series dice = test::normals(whole.size(), 9);
  std::size_t missing = 0;
  for (std::size_t k = 0; k < holed.size(); ++k) {
    if (dice[k] < 2.3263) continue;
    holed[k] = nan_value;
    ++missing;
  }
  const NoiseAnalysis complete = analysed(whole, at_rest()), found = analysed(holed, at_rest());
  EXPECT_EQ(found.missing, missing);
  EXPECT_EQ(found.samples, whole.size());
  EXPECT_TRUE(says(found, "are missing"));
  ASSERT_GT(found.deviation.points.size(), 20U);
  for (const DeviationPoint& point : found.deviation.points) {
    const auto other =
        std::find_if(complete.deviation.points.begin(), complete.deviation.points.end(),
                     [&](const DeviationPoint& candidate) { return candidate.m == point.m; });
    ASSERT_NE(other, complete.deviation.points.end());
    EXPECT_LT(std::abs(point.value - other->value),
              std::max(0.02 * other->value, 0.5 * (other->upper - other->lower)))
        << point.m;
  }
  EXPECT_NEAR(found.model.white.value, 1e-3, 3.5 * found.model.white.std);
  EXPECT_NEAR(found.model.random_walk.value, 5e-4, 3.5 * found.model.random_walk.std);
}

TEST(AnalyseNoise, ALongGapCostsDegreesOfFreedomOnly) {
  const Series whole = test::white(1e-3, rate_hz, 40'000, 10);
  Series gapped = whole;
  for (std::size_t k = 15'000; k < 25'000; ++k) gapped[k] = nan_value;
  const NoiseAnalysis complete = analysed(whole, at_rest()), found = analysed(gapped, at_rest());
  EXPECT_EQ(found.missing, 10'000U);
  for (const DeviationPoint& point : found.deviation.points) {
    const double expected = 1e-3 / std::sqrt(point.tau_s);
    EXPECT_LT(std::abs(point.value - expected), 2.5 * (point.upper - point.lower)) << point.m;
  }
  EXPECT_LT(found.deviation.points[10].edf, 0.8 * complete.deviation.points[10].edf);
  EXPECT_NEAR(found.model.white.value, 1e-3, 3.5 * found.model.white.std);
  EXPECT_EQ(found.model.random_walk.verdict, Verdict::not_observable);
}

TEST(AnalyseNoise, OfAWholeRecordStatisticUsesTheLongestPieceAndSaysSo) {
  Series gapped = test::white(1e-3, rate_hz, 5000, 11);
  for (std::size_t k = 1000; k < 1100; ++k) gapped[k] = nan_value;
  NoiseOptions options = at_rest();
  options.statistic = Statistic::totdev;
  const NoiseAnalysis found = analysed(gapped, options);
  EXPECT_TRUE(says(found, "1100 of 5000 samples are excluded"));
  const NoiseAnalysis alone = analysed(View<double>(gapped).subspan(1100), options);
  ASSERT_EQ(found.deviation.points.size(), alone.deviation.points.size());
  for (std::size_t k = 0; k < alone.deviation.points.size(); ++k)
    EXPECT_NEAR(found.deviation.points[k].value / alone.deviation.points[k].value, 1.0, 1e-9);
}

TEST(AnalyseNoise, RefusesWhatDoesNotVary) {
  const auto constant = analyse_noise(Series(1000, 9.81), at_rest());
  ASSERT_FALSE(constant.has_value());
  EXPECT_EQ(constant.error().code, Errc::not_observable);
  EXPECT_NE(constant.error().message.find("do not vary"), std::string::npos);
}

TEST(AnalyseNoise, RefusesWhatHoldsNoNumber) {
  const auto nothing = analyse_noise(Series(1000, nan_value), at_rest());
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(nothing.error().code, Errc::not_finite);
  const auto infinite =
      analyse_noise(Series(100, std::numeric_limits<double>::infinity()), at_rest());
  ASSERT_FALSE(infinite.has_value());
  EXPECT_EQ(infinite.error().code, Errc::not_finite);
}

Series rounded(Series series, double lsb) {
  for (double& value : series) value = lsb * std::round(value / lsb);
  return series;
}

TEST(AnalyseNoise, RefusesNoiseBelowHalfAStepOfTheConverterAndSaysWhy) {
  NoiseOptions options = at_rest();
  options.lsb = 0.01;
  for (const double offset : {0.0, 0.2, 0.5}) {
    Series series = sum_of(
        {test::scaled(test::normals(20'000, 12), 0.2 * 0.01), Series(20'000, 1.0 + offset * 0.01)});
    const auto coarse = analyse_noise(rounded(std::move(series), 0.01), options);
    ASSERT_FALSE(coarse.has_value()) << offset;
    EXPECT_EQ(coarse.error().code, Errc::not_observable);
    EXPECT_NE(coarse.error().message.find("half a step"), std::string::npos)
        << coarse.error().message;
  }
}

TEST(AnalyseNoise, TakesNoiseOfOneStepAndWarns) {
  NoiseOptions options = at_rest();
  options.lsb = 0.01;
  const double sigma = 0.01;
  const NoiseAnalysis found =
      analysed(rounded(test::scaled(test::normals(40'000, 13), sigma), 0.01), options);
  // Sheppard's correction: rounding adds a twelfth of the squared step.
  const double expected = std::sqrt((sigma * sigma + 1e-4 / 12.0) / rate_hz);
  EXPECT_NEAR(found.model.white.value / expected, 1.0, 0.02);
  EXPECT_EQ(found.lsb, 0.01);
  EXPECT_TRUE(says(found, "the quantisation step"));
  EXPECT_TRUE(std::any_of(found.notes.begin(), found.notes.end(),
                          [](const Note& note) { return note.severity == Severity::warning; }));
}

TEST(AnalyseNoise, AFineStepGivesNoWarning) {
  NoiseOptions options = at_rest();
  options.lsb = 0.01;
  const NoiseAnalysis found = analysed(rounded(test::normals(20'000, 14), 0.01), options);
  for (const Note& note : found.notes) EXPECT_EQ(note.severity, Severity::info) << note.text;
}

Series disturbed(const Series& noise) {
  Series series = noise;
  for (std::size_t k = 0; k < 40; ++k)
    series[20'000 + k] +=
        0.5 * std::sin(0.9 * static_cast<double>(k)) * std::exp(-0.1 * static_cast<double>(k));
  for (std::size_t k = 40'000; k < series.size(); ++k) series[k] += 0.1;
  return series;
}

TEST(AnalyseNoise, ReportsOutliersAndStepsAndExcludesThemOnRequest) {
  const Series noise = test::white(1e-3, rate_hz, 60'000, 15);
  const NoiseAnalysis clean = analysed(noise, at_rest());
  EXPECT_TRUE(clean.events.empty());
  NoiseOptions options = at_rest();
  const NoiseAnalysis kept = analysed(disturbed(noise), options);
  options.exclude_events = true;
  const NoiseAnalysis dropped = analysed(disturbed(noise), options);
  EXPECT_GE(kept.events.size(), 2U);
  EXPECT_EQ(dropped.events.size(), kept.events.size());
  EXPECT_EQ(kept.missing, 0U);
  EXPECT_GT(dropped.missing, 0U);
  EXPECT_TRUE(says(kept, "included in the figures"));
  EXPECT_TRUE(says(dropped, " excluded"));
  const DeviationPoint &of_kept = kept.deviation.points.back(),
                       &of_dropped = dropped.deviation.points.back(),
                       &of_clean = clean.deviation.points.back();
  EXPECT_GT(of_kept.value, 5.0 * of_clean.value);
  EXPECT_LT(of_dropped.value, 0.05 * of_kept.value);
  EXPECT_NEAR(dropped.model.white.value, 1e-3, 3.5 * dropped.model.white.std);
}

TEST(AnalyseNoise, IntervalsContainTheNoiseWithoutOutliers) {
  Series noise = test::white(1e-3, rate_hz, 60'000, 15);
  for (std::size_t k = 500; k < noise.size(); k += 3000) noise[k] += 1.0;
  const Coefficient found = analysed(noise, at_rest()).model.white;
  EXPECT_GT(found.value, 1.5e-3);
  EXPECT_LT(found.lower_95, 1e-3);
  EXPECT_NEAR(found.value, 1e-3, 2.1 * found.std);
}

TEST(AnalyseNoise, RefusesOptionsThatMakeNoSense) {
  const Series series = test::normals(100, 16);
  const auto refused = [&](auto change) {
    NoiseOptions options = at_rest();
    change(options);
    const auto result = analyse_noise(series, options);
    return !result.has_value() && result.error().code == Errc::invalid_argument;
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const double rate : {0.0, -1.0, nan_value, infinite})
    EXPECT_TRUE(refused([=](NoiseOptions& o) { o.rate_hz = rate; })) << rate;
  for (const double confidence : {0.0, 1.0, -0.5, nan_value})
    EXPECT_TRUE(refused([=](NoiseOptions& o) { o.confidence = confidence; })) << confidence;
  for (const int alpha : {3, -5}) {
    EXPECT_TRUE(refused([=](NoiseOptions& o) {
      o.noise_type = NoiseTypeSource::fixed;
      o.alpha = alpha;
    })) << alpha;
  }
}

TEST(AnalyseNoise, RefusesFewerThanThreeSamples) {
  for (std::size_t samples = 0; samples < 3; ++samples) {
    const auto result = analyse_noise(Series(samples, 1.0), at_rest());
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, Errc::too_few_samples);
  }
}

TEST(AnalyseNoise, RefusesEveryTauOfALongRecord) {
  NoiseOptions options = at_rest();
  options.taus.kind = TauGrid::Kind::all;
  const auto result = analyse_noise(Series(1'000'000, 0.0), options);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, Errc::invalid_argument);
}

TEST(AnalyseNoise, ReportsProgress) {
  std::vector<double> fractions;
  NoiseOptions options = at_rest();
  options.progress = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
  (void)analysed(test::normals(1000, 17), options);
  ASSERT_GE(fractions.size(), 2U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(AnalyseNoise, SaysTheSameInAnyUnit) {
  const Series series =
      sum_of({test::white(1.0, 100.0, 5000, 1), test::random_walk(0.3, 100.0, 5000, 2)});
  const NoiseAnalysis one = analyse_noise(series, {.rate_hz = 100.0}).value();
  for (const double factor : {1e-30, 1e-12, 1e12}) {
    const NoiseAnalysis other =
        analyse_noise(test::scaled(series, factor), {.rate_hz = 100.0}).value();
    EXPECT_NEAR(other.model.white.value / factor, one.model.white.value, 1e-6) << factor;
    EXPECT_NEAR(other.model.random_walk.value / factor, one.model.random_walk.value, 1e-5);
    EXPECT_NEAR(other.model.ramp.upper_95 / factor, one.model.ramp.upper_95, 1e-4);
    EXPECT_NEAR(other.deviation.points.back().upper / factor, one.deviation.points.back().upper,
                1e-6);
  }
  for (const double factor : {1e-100, 1e100}) {
    const auto refused = analyse_noise(test::scaled(series, factor), {.rate_hz = 100.0});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, Errc::not_observable);
  }
}

}  // namespace
}  // namespace proofmass::characterise::noise_analysis_test
