#include "proofmass/characterise/drift_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/characterise/drift/drift_test_support.hpp"

namespace proofmass::characterise::drift_analysis_test {
namespace {

using test::Series;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// a1 = 5, T = 60 s, a2 = 1.5 in white noise, 600 s at 1 Hz.
constexpr std::size_t n = 600;
Series record(unsigned seed) {
  return test::sum_of(
      {test::warm_up(5.0, 60.0, 1.0, n), test::level(1.5, n), test::white(0.5, 1.0, n, seed)});
}

DriftAnalysis analysed(const Series& series, const DriftOptions& options = {.rate_hz = 1.0}) {
  return analyse_drift(series, options).value();
}

Error refused(const Series& series, const DriftOptions& options = {.rate_hz = 1.0}) {
  return analyse_drift(series, options).error();
}

bool holds(const std::optional<Interval95>& interval, double truth) {
  return interval && interval->lower_95 && interval->upper_95 && *interval->lower_95 <= truth &&
         truth <= *interval->upper_95;
}

void expect_warm_up(const DriftFit& fit) {
  ASSERT_TRUE(fit.identified) << fit.reason;
  EXPECT_TRUE(holds(fit.a1, 5.0));
  EXPECT_TRUE(holds(fit.time_constant_s, 60.0));
  EXPECT_TRUE(holds(fit.a2, 1.5));
}

bool has_note(const DriftAnalysis& analysis, Severity severity, const std::string& words) {
  return std::ranges::any_of(analysis.notes, [&](const Note& note) {
    return note.severity == severity && note.text.find(words) != std::string::npos;
  });
}

TEST(DriftAnalysis, FindsTheWarmUpOfARecording) {
  const DriftAnalysis analysis = analysed(record(1));
  expect_warm_up(analysis.fit);
  EXPECT_EQ(analysis.samples, n);
  EXPECT_EQ(analysis.missing, 0U);
  EXPECT_EQ(analysis.block_s, 1.0);
  EXPECT_EQ(analysis.duration_s, 600.0);
  EXPECT_TRUE(analysis.outliers.empty());
  EXPECT_TRUE(analysis.notes.empty());
  EXPECT_TRUE(analysis.noise_explained);
  ASSERT_TRUE(analysis.whitened);
  for (const signal::WhitenessTest& test : analysis.whiteness)
    EXPECT_TRUE(test.white) << test.scale_s;
}

TEST(DriftAnalysis, FitsMeansOverBlocksOfALongRecording) {
  Series series =
      test::sum_of({test::warm_up(5.0, 60.0, 8.0, 8 * n), test::white(0.2, 8.0, 8 * n, 2)});
  const DriftAnalysis analysis = analysed(series, {.rate_hz = 8.0});
  // 4800 samples in blocks of three: the number of blocks is at most 2048, all complete.
  EXPECT_DOUBLE_EQ(analysis.block_s, 3.0 / 8.0);
  ASSERT_EQ(analysis.block_mean.size(), 1600U);
  for (const std::size_t block : {0UL, 700UL, 1599UL})
    EXPECT_NEAR(analysis.block_mean[block],
                (series[3 * block] + series[3 * block + 1] + series[3 * block + 2]) / 3.0, 1e-12);
  EXPECT_TRUE(holds(analysis.fit.a1, 5.0));
  EXPECT_TRUE(holds(analysis.fit.time_constant_s, 60.0));
}

// A table of means, one per power-up: rows instead of samples.
TEST(DriftAnalysis, TakesATableOfTwelveValuesOrMore) {
  Series table = test::sum_of({test::warm_up(5.0, 4.0, 1.0, 30), test::white(0.1, 1.0, 30, 3)});
  const DriftAnalysis analysis = analysed(table, {.rate_hz = 1.0});
  ASSERT_TRUE(analysis.fit.identified) << analysis.fit.reason;
  EXPECT_NEAR(analysis.fit.time_constant_s->value, 4.0, 4.0 * analysis.fit.time_constant_s->std);
  EXPECT_EQ(analysis.block_s, 1.0);
  table.resize(12);
  EXPECT_TRUE(analyse_drift(table, {.rate_hz = 1.0}));
  table.resize(11);
  EXPECT_EQ(refused(table).code, Errc::too_few_samples);
}

TEST(DriftAnalysis, ExcludesNonFiniteValues) {
  Series series = record(3);
  for (std::size_t k = 7; k < n; k += 60) series[k] = missing;
  series[100] = std::numeric_limits<double>::infinity();
  const DriftAnalysis analysis = analysed(series);
  expect_warm_up(analysis.fit);
  EXPECT_EQ(analysis.missing, 11U);
  EXPECT_TRUE(std::isnan(analysis.block_mean[100]));
  EXPECT_TRUE(has_note(analysis, Severity::warning, "11 of 600 blocks of 1 s are missing"));
}

TEST(DriftAnalysis, CountsBlocksOfWhichTooLittleIsThere) {
  Series series = test::normals(8192, 1);
  for (std::size_t k = 0; k < series.size(); ++k)
    if (k % 4 != 0) series[k] = missing;
  EXPECT_EQ(refused(series).code, Errc::too_few_samples);
}

TEST(DriftAnalysis, GoesAcrossAGapOfATenth) {
  Series series = record(4);
  for (std::size_t k = 200; k < 260; ++k) series[k] = missing;
  const DriftAnalysis analysis = analysed(series);
  expect_warm_up(analysis.fit);
  EXPECT_EQ(analysis.missing, 60U);
  // Fewer, longer blocks, since each missing one costs a column.
  EXPECT_EQ(analysis.block_s, 2.0);
  EXPECT_TRUE(has_note(analysis, Severity::warning, "30 of 300 blocks"));
  EXPECT_TRUE(std::isfinite(analysis.residual_rms));
}

TEST(DriftAnalysis, RefusesARecordingOfWhichMoreThanHalfIsMissing) {
  Series series = record(5);
  for (std::size_t k = 100; k < 420; ++k) series[k] = missing;
  EXPECT_EQ(refused(series).code, Errc::too_few_samples);
}

TEST(DriftAnalysis, RefusesLessThanTwelveSamples) {
  EXPECT_EQ(refused(test::normals(11, 1)).code, Errc::too_few_samples);
  EXPECT_EQ(refused({}).code, Errc::too_few_samples);
  EXPECT_TRUE(analyse_drift(test::normals(12, 1), {.rate_hz = 1.0}));
}

TEST(DriftAnalysis, RefusesWhatDoesNotVary) {
  Series series(n, 9.8);
  EXPECT_EQ(refused(series).code, Errc::not_observable);
  series[3] = missing;
  EXPECT_EQ(refused(series).code, Errc::not_observable);
}

TEST(DriftAnalysis, RefusesASeriesOfMissingSamples) {
  EXPECT_EQ(refused(Series(n, missing)).code, Errc::not_finite);
  EXPECT_EQ(refused(Series(n, std::numeric_limits<double>::infinity())).code, Errc::not_finite);
}

TEST(DriftAnalysis, RefusesOptionsThatMakeNoSense) {
  for (const double rate_hz :
       {0.0, -1.0, 1e-300, 1e300, missing, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(refused(record(1), {.rate_hz = rate_hz}).code, Errc::invalid_argument);
  for (const double since_s : {-1.0, missing, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(refused(record(1), {.rate_hz = 1.0, .since_switch_on_s = since_s}).code,
              Errc::invalid_argument);
}

TEST(DriftAnalysis, ExcludesOutliers) {
  const Series quiet = record(6);
  Series series = quiet;
  for (std::size_t k = 300; k < 302; ++k) series[k] += 40.0;
  const DriftAnalysis analysis = analysed(series), without = analysed(quiet);
  ASSERT_EQ(analysis.outliers.size(), 1U);
  EXPECT_LE(analysis.outliers[0].first, 300U);
  EXPECT_GE(analysis.outliers[0].last, 301U);
  EXPECT_GE(analysis.missing, 2U);
  EXPECT_TRUE(std::isnan(analysis.block_mean[300]));
  EXPECT_TRUE(has_note(analysis, Severity::info, "1 outlier excluded"));
  ASSERT_TRUE(analysis.fit.identified && without.fit.identified);
  EXPECT_NEAR(analysis.fit.a1->value, without.fit.a1->value, 0.2 * without.fit.a1->std);
  EXPECT_LT(*std::ranges::max_element(analysis.data.upper), 20.0);
}

TEST(DriftAnalysis, KeepsStepsAsDrift) {
  const DriftAnalysis analysis =
      analysed(test::sum_of({test::white(0.5, 1.0, n, 7), test::step_at(250, 6.0, n)}));
  EXPECT_EQ(analysis.missing, 0U);
  EXPECT_EQ(analysis.fit.why, DriftReason::steps);
  ASSERT_EQ(analysis.fit.curve.steps.size(), 1U);
  // Between the samples at 249 and 250 s.
  EXPECT_DOUBLE_EQ(analysis.fit.curve.steps[0].t_s, 249.5);
}

TEST(DriftAnalysis, FindsAWarmUpToTheLastDigitThatItsNoiseLeaves) {
  // Samples at 0, 1, 2 … s with noise a millionth of the signal, and a gap in the steep initial
  // part.
  const std::size_t many = 7200;
  Series series = test::white(1e-6, 1.0, many, 21);
  for (std::size_t k = 0; k < many; ++k)
    series[k] += -0.21 + 0.25 * (1.0 - std::exp(-static_cast<double>(k) / 70.0));
  series[60] = series[61] = missing;
  const DriftAnalysis analysis = analysed(series);
  ASSERT_TRUE(analysis.fit.identified);
  EXPECT_NEAR(analysis.fit.time_constant_s->value, 70.0, 5e-3);
  EXPECT_NEAR(analysis.fit.a1->value, 0.25, 1e-5);
  EXPECT_NEAR(analysis.fit.a2.value, -0.21, 1e-5);
}

TEST(DriftAnalysis, SaysThatASlowOscillationIsNeitherNoiseNorAnExponential) {
  const std::size_t many = 7200;
  Series series = test::white(1e-3, 1.0, many, 22);
  for (std::size_t k = 0; k < many; ++k)
    series[k] += 0.1 * std::sin(2.0 * 3.141592653589793 * static_cast<double>(k) / 3000.0);
  const DriftAnalysis analysis = analysed(series);
  EXPECT_FALSE(analysis.fit.identified);
  EXPECT_EQ(analysis.fit.why, DriftReason::unexplained);
}

TEST(DriftAnalysis, CountsItsTimesFromSwitchingOn) {
  const DriftAnalysis analysis = analysed(record(8));
  const DriftAnalysis later = analysed(record(8), {.rate_hz = 1.0, .since_switch_on_s = 30.0});
  EXPECT_EQ(later.start_s, 30.0);
  EXPECT_DOUBLE_EQ(later.fit.end.t_s, analysis.fit.end.t_s + 30.0);
  ASSERT_EQ(later.data.t_s.size(), analysis.data.t_s.size());
  for (std::size_t k = 0; k < later.data.t_s.size(); ++k)
    EXPECT_DOUBLE_EQ(later.data.t_s[k], analysis.data.t_s[k] + 30.0);
  // The same exponential, started 30 s earlier and correspondingly larger.
  ASSERT_TRUE(analysis.fit.identified && later.fit.identified);
  const double T = analysis.fit.time_constant_s->value;
  EXPECT_NEAR(later.fit.time_constant_s->value, T, 0.01);
  EXPECT_NEAR(later.fit.a1->value, analysis.fit.a1->value * std::exp(30.0 / T), 0.01);
  EXPECT_NEAR(later.fit.curve.value(130.0), analysis.fit.curve.value(100.0), 1e-3);
}

TEST(DriftAnalysis, HasTheResidualOfTheSamplesAboutItsCurve) {
  Series series = record(9);
  series[17] = missing;
  const DriftAnalysis analysis = analysed(series, {.rate_hz = 1.0, .since_switch_on_s = 10.0});
  const DriftCurve& curve = analysis.fit.curve;
  double squares = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 17) continue;
    const double t_s = 10.0 + static_cast<double>(k);
    const double fitted = curve.a2 + curve.a1 * (1.0 - std::exp(-t_s / curve.time_constant_s));
    squares += (series[k] - fitted) * (series[k] - fitted);
  }
  EXPECT_NEAR(analysis.residual_rms, std::sqrt(squares / (static_cast<double>(n) - 1.0)), 1e-12);
}

TEST(DriftAnalysis, HasAnEnvelopeThatKeepsTheExtremes) {
  const std::size_t many = 5003;
  const Series series =
      test::sum_of({test::white(0.5, 10.0, many, 10), test::ramp(1e-3, 10.0, many)});
  const DriftAnalysis analysis = analysed(series, {.rate_hz = 10.0});
  ASSERT_TRUE(analysis.outliers.empty());
  const Envelope& data = analysis.data;
  // Six samples per interval.
  ASSERT_EQ(data.t_s.size(), 834U);
  EXPECT_EQ(data.scale_s, 0.1);
  for (std::size_t k = 0; k < data.t_s.size(); ++k) {
    const auto from = series.begin() + static_cast<std::ptrdiff_t>(6 * k);
    const auto to = series.begin() + static_cast<std::ptrdiff_t>(std::min(6 * k + 6, many));
    EXPECT_EQ(data.lower[k], *std::min_element(from, to));
    EXPECT_EQ(data.upper[k], *std::max_element(from, to));
  }
  EXPECT_DOUBLE_EQ(data.t_s.front(), 0.25);
  EXPECT_DOUBLE_EQ(data.t_s[1], 0.85);
  ASSERT_EQ(analysis.residuals.size(), 3U);
  EXPECT_EQ(analysis.residuals[0].scale_s, 0.1);
  for (const Envelope& residual : analysis.residuals) {
    EXPECT_LE(residual.t_s.size(), 1000U);
    for (std::size_t k = 0; k < residual.t_s.size(); ++k)
      EXPECT_LE(residual.lower[k], residual.upper[k]);
  }
}

TEST(DriftAnalysis, SaysWhereTheNoiseIsNotWhatItWasTakenFor) {
  // No noise model contains a line at a third of the rate.
  const DriftAnalysis analysis = analysed(test::sum_of({record(11), test::sine(3.0, 0.3, 1.0, n)}));
  EXPECT_FALSE(analysis.noise_explained);
}

TEST(DriftAnalysis, ReportsProgressUntilTheEnd) {
  std::vector<double> fractions;
  ASSERT_TRUE(analyse_drift(
      record(12), {.rate_hz = 1.0, .progress = [&](std::string_view stage, double fraction) {
                     EXPECT_EQ(stage, "drift");
                     fractions.push_back(fraction);
                   }}));
  ASSERT_GE(fractions.size(), 3U);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(DriftAnalysis, RefusesBlocksThatDoNotVaryThoughTheirSamplesDo) {
  Series series(8192);
  for (std::size_t k = 0; k < series.size(); ++k) series[k] = k % 2 == 0 ? 1.0 : -1.0;
  const Error error = refused(series);
  EXPECT_EQ(error.code, Errc::not_observable);
  EXPECT_NE(error.message.find("means over blocks do not vary"), std::string::npos);
}

TEST(DriftAnalysis, TakesAnyUnitThatItCanSquareTwice) {
  for (const double size : {1e-50, 1e50})
    EXPECT_TRUE(analysed(test::scaled(record(13), size)).fit.identified);
}

TEST(DriftAnalysis, RefusesFiguresThatNoDoubleCanSquareTwice) {
  for (const double size : {1e300, 1e160, 1e80, 1e-80, 1e-160, 1e-300})
    EXPECT_EQ(refused(test::scaled(record(13), size)).code, Errc::unsupported) << size;
  // Block means of denormal numbers may all be equal.
  const Errc least = refused(test::scaled(record(13), 5e-324)).code;
  EXPECT_TRUE(least == Errc::unsupported || least == Errc::not_observable);
  Series extreme(n);
  for (std::size_t k = 0; k < n; ++k)
    extreme[k] = k % 3 == 0 ? 1e308 : k % 3 == 1 ? -1e308 : 5e-324;
  EXPECT_FALSE(analyse_drift(extreme, {.rate_hz = 1.0}));
}

TEST(DriftAnalysis, TakesASampleThatCannotBeForAnOutlier) {
  Series series = record(13);
  series[340] = 1e300;
  series[341] = -1e300;
  const DriftAnalysis analysis = analysed(series);
  EXPECT_GE(analysis.missing, 2U);
  EXPECT_TRUE(analysis.fit.identified);
  EXPECT_LT(analysis.residual_rms, 1.0);
}

}  // namespace
}  // namespace proofmass::characterise::drift_analysis_test
