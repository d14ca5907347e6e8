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

/// Phase of the 10-point set of W. J. Riley, NIST SP 1065 (2008), p. 107.
const Series ten_phases = {0,        103.11111, 123.22222, 157.33333, 166.44444,
                           48.55555, -96.33333, -2.22222,  111.88889, 0};

Series rates_of(View<double> phase) {
  Series rates;
  for (std::size_t k = 0; k + 1 < phase.size(); ++k) rates.push_back(phase[k + 1] - phase[k]);
  return rates;
}

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

struct Published {
  Statistic statistic;
  std::vector<std::pair<double, double>> tau_and_deviation;
  bool uncorrected = false;  ///< published without bias correction
  bool to_five_digits = false;
};

// NOLINTNEXTLINE(readability-identifier-naming): name required by GoogleTest
void PrintTo(const Published& published, std::ostream* out) {
  *out << name_of(published.statistic) << (published.uncorrected ? ", uncorrected" : "");
}

void expect_published(const Series& phase, const Published& published) {
  const Series rates = rates_of(phase);
  for (const SeriesKind kind : {SeriesKind::phase, SeriesKind::rate}) {
    NoiseOptions options = options_for(published.statistic, kind);
    options.taus.kind = TauGrid::Kind::given;
    const double per_m = published.statistic == Statistic::theo1 ? 0.75 : 1.0;
    for (const auto& [tau_s, deviation] : published.tau_and_deviation)
      options.taus.times_s.push_back(tau_s);
    const NoiseAnalysis found = analysed(kind == SeriesKind::phase ? phase : rates, options);
    EXPECT_EQ(found.samples, rates.size());
    ASSERT_EQ(found.deviation.points.size(), published.tau_and_deviation.size());
    for (std::size_t k = 0; k < found.deviation.points.size(); ++k) {
      const DeviationPoint& point = found.deviation.points[k];
      const auto& [tau_s, deviation] = published.tau_and_deviation[k];
      EXPECT_DOUBLE_EQ(point.tau_s, per_m * tau_s);
      const double value = published.uncorrected ? point.uncorrected : point.value;
      EXPECT_NEAR(value / deviation, 1.0, published.to_five_digits ? 5e-5 : 5e-7) << tau_s;
      EXPECT_EQ(point.alpha, 0);
      EXPECT_LT(point.lower, point.value);
      EXPECT_LT(point.value, point.upper);
    }
  }
}

class TenPoints : public testing::TestWithParam<Published> {};
class ThousandPoints : public testing::TestWithParam<Published> {};

TEST_P(TenPoints, AreAsNistPublishedThemAsPhaseAndAsRate) {
  expect_published(ten_phases, GetParam());
}

TEST_P(ThousandPoints, AreAsNistPublishedThemAsPhaseAndAsRate) {
  expect_published(test::nbs14_phase(), GetParam());
}

// Corrected as for white frequency noise throughout.
INSTANTIATE_TEST_SUITE_P(
    Nist,
    TenPoints,
    testing::Values(Published{Statistic::adev, {{1, 91.22945}, {2, 115.8082}}},
                    Published{Statistic::oadev, {{1, 91.22945}, {2, 85.95287}}},
                    Published{Statistic::mdev, {{1, 91.22945}, {2, 74.78849}}},
                    Published{Statistic::tdev, {{1, 52.67135}, {2, 86.35831}}},
                    Published{Statistic::hdev, {{1, 70.80608}, {2, 116.7980}}},
                    Published{Statistic::ohdev, {{1, 70.80607}, {2, 85.61487}}},
                    Published{Statistic::totdev, {{1, 91.22945}, {2, 93.90379}}},
                    Published{Statistic::mtotdev, {{1, 75.50203}, {2, 75.83606}}},
                    Published{Statistic::mtotdev, {{1, 64.509}, {2, 64.794}}, true, true},
                    Published{Statistic::ttotdev, {{1, 43.59112}, {2, 87.56794}}},
                    Published{Statistic::ttotdev, {{1, 37.244}, {2, 74.818}}, true, true},
                    Published{Statistic::htotdev, {{1, 70.80607}, {2, 91.16396}}}));

INSTANTIATE_TEST_SUITE_P(
    Nist,
    ThousandPoints,
    testing::Values(
        Published{Statistic::adev, {{1, 2.922319e-1}, {10, 9.965736e-2}, {100, 3.897804e-2}}},
        Published{Statistic::oadev, {{1, 2.922319e-1}, {10, 9.159953e-2}, {100, 3.241343e-2}}},
        Published{Statistic::mdev, {{1, 2.922319e-1}, {10, 6.172376e-2}, {100, 2.170921e-2}}},
        Published{Statistic::tdev, {{1, 1.687202e-1}, {10, 3.563623e-1}, {100, 1.253382}}},
        Published{Statistic::hdev, {{1, 2.943883e-1}, {10, 1.052754e-1}, {100, 3.910860e-2}}},
        Published{Statistic::ohdev, {{1, 2.943883e-1}, {10, 9.581083e-2}, {100, 3.237638e-2}}},
        Published{Statistic::totdev, {{1, 2.922319e-1}, {10, 9.134743e-2}, {100, 3.406530e-2}}},
        Published{Statistic::mtotdev, {{1, 2.418528e-1}, {10, 6.499161e-2}, {100, 2.287774e-2}}},
        Published{Statistic::ttotdev, {{1, 1.1930e-1}, {10, 3.2060e-1}, {100, 1.1285}}, true, true},
        Published{Statistic::htotdev, {{1, 2.943883e-1}, {10, 9.614787e-2}, {100, 3.058103e-2}}},
        Published{
            Statistic::theo1, {{10, 1.0757e-1}, {100, 3.1789e-2}, {1000, 5.0524e-3}}, true, true},
        Published{Statistic::pdev,
                  {{1, 0.29223188},
                   {2, 0.21445234},
                   {4, 0.15618112},
                   {8, 0.11709746},
                   {16, 0.069029585},
                   {32, 0.049749708},
                   {64, 0.038947417},
                   {128, 0.030862393},
                   {256, 0.012447414}}}));

/// Accepted difference from Stable32's limits: where its degrees of freedom differ from those of SP
/// 1065 (allan/edf_test.cpp), plus half a unit of the last printed digit.
double tolerance_of(Statistic statistic, const test::Stable32Row& row) {
  const bool modified_total = statistic == Statistic::mtotdev || statistic == Statistic::ttotdev;
  if (modified_total && row.m >= 10) return row.alpha == 0 ? 0.032 : 0.065;
  if (statistic == Statistic::totdev && row.m == 1) return 0.01;
  if (statistic == Statistic::htotdev && row.alpha == 1) return 0.02;
  return 0.005;
}

void expect_stable32(Statistic statistic, const std::string& table, const NoiseOptions& asked) {
  const auto file = test::stable32_folder() / ("phase_dat_" + table + ".txt");
  const auto rows = test::read_stable32_table(file);
  ASSERT_GE(rows.size(), 8U) << table;
  NoiseOptions options = asked;
  options.statistic = statistic;
  options.kind = SeriesKind::phase;
  options.rate_hz = 1.0;
  options.taus.kind = TauGrid::Kind::octave;
  const NoiseAnalysis found = analysed(test::nbs14_phase(), options);
  std::size_t compared = 0;
  for (const test::Stable32Row& row : rows) {
    SCOPED_TRACE(testing::Message() << table << ", m = " << row.m);
    const auto point =
        std::find_if(found.deviation.points.begin(), found.deviation.points.end(),
                     [&](const DeviationPoint& candidate) { return candidate.m == row.m; });
    ASSERT_NE(point, found.deviation.points.end());
    if (point->alpha != row.alpha) continue;
    ++compared;
    // Some of its tables are not corrected for bias.
    EXPECT_NEAR(std::min(std::abs(point->value / row.deviation - 1.0),
                         std::abs(point->uncorrected / row.deviation - 1.0)),
                0.0, 5e-5);
    const double tolerance = tolerance_of(statistic, row);
    EXPECT_NEAR(point->lower / point->value / (row.lower / row.deviation), 1.0, tolerance);
    EXPECT_NEAR(point->upper / point->value / (row.upper / row.deviation), 1.0, tolerance);
  }
  // In some of its last rows the noise types differ from ours.
  EXPECT_GE(compared + 2, rows.size()) << table;
}

const std::vector<Statistic> in_tables = {Statistic::adev,   Statistic::oadev,   Statistic::mdev,
                                          Statistic::tdev,   Statistic::hdev,    Statistic::ohdev,
                                          Statistic::totdev, Statistic::mtotdev, Statistic::ttotdev,
                                          Statistic::htotdev};

TEST(AnalyseNoise, GivesStable32sLimitsByLag1AndWithTheNoiseTypeFixed) {
  if (test::stable32_folder().empty())
    GTEST_SKIP() << "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder";
  NoiseOptions lag1, fixed;
  lag1.noise_type = NoiseTypeSource::lag1;
  fixed.noise_type = NoiseTypeSource::fixed;
  for (const Statistic statistic : in_tables) {
    const std::string table = std::string(name_of(statistic)) + "_octave";
    expect_stable32(statistic, table, lag1);
    expect_stable32(statistic, table, fixed);
  }
}

// The mean of a rate over a sample has other degrees of freedom than Stable32's phase: 667 of 999
// instead of 782, which changes the limits at m = 1 by at most half a percent.
TEST(AnalyseNoise, GivesStable32sLimitsByTheModelToo) {
  if (test::stable32_folder().empty())
    GTEST_SKIP() << "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder";
  for (const Statistic statistic : in_tables)
    expect_stable32(statistic, std::string(name_of(statistic)) + "_octave", {});
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
