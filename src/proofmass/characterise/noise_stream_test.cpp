#include "proofmass/characterise/noise_stream.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace proofmass::characterise::noise_stream_test {
namespace {

std::vector<double> white_and_random_walk(std::size_t n) {
  std::mt19937_64 rng(21);
  std::normal_distribution<double> normal;
  std::vector<double> y(n);
  double walk = 9.8;
  for (double& v : y) v = normal(rng) + (walk += 0.01 * normal(rng));
  return y;
}

Result<NoiseAnalysis> in_pieces(View<double> series,
                                const NoiseOptions& options,
                                const StreamEnd& end = {}) {
  NoiseStream stream = NoiseStream::start(options, series.size()).value();
  for (std::size_t from = 0, size = 1; from < series.size();
       from += size, size = size * 7 % 4093 + 1)
    stream.add(series.subspan(from, std::min(size, series.size() - from)));
  return stream.finish(end);
}

std::vector<std::string> texts_of(const NoiseAnalysis& analysis) {
  std::vector<std::string> texts;
  for (const Note& note : analysis.notes)
    if (!note.text.starts_with("outliers and steps")) texts.push_back(note.text);
  return texts;
}

TEST(NoiseStream, SaysWhatTheAnalysisOfTheWholeSays) {
  std::vector<double> y = white_and_random_walk(100'000);
  for (std::size_t k = 40'000; k < 40'500; ++k) y[k] = std::nan("");
  for (const Statistic statistic :
       {Statistic::oadev, Statistic::mdev, Statistic::tdev, Statistic::ohdev}) {
    SCOPED_TRACE(name_of(statistic));
    const NoiseOptions options{.rate_hz = 100.0, .statistic = statistic, .lsb = 0.01};
    const NoiseAnalysis whole = analyse_noise(y, options).value();
    const NoiseAnalysis found = in_pieces(y, options, {.lsb = 0.01}).value();
    EXPECT_EQ(found.samples, whole.samples);
    EXPECT_EQ(found.missing, whole.missing);
    EXPECT_EQ(found.duration_s, whole.duration_s);
    EXPECT_EQ(found.mean, whole.mean);
    EXPECT_EQ(found.lsb, whole.lsb);
    EXPECT_NEAR(found.model.white.value / whole.model.white.value, 1.0, 1e-9);
    EXPECT_NEAR(found.model.random_walk.value / whole.model.random_walk.value, 1.0, 1e-6);
    ASSERT_EQ(found.deviation.points.size(), whole.deviation.points.size());
    for (std::size_t k = 0; k < whole.deviation.points.size(); ++k) {
      EXPECT_NEAR(found.deviation.points[k].value / whole.deviation.points[k].value, 1.0, 1e-9);
      EXPECT_NEAR(found.deviation.points[k].upper / whole.deviation.points[k].upper, 1.0, 1e-6);
    }
    EXPECT_EQ(texts_of(found), texts_of(whole));
    EXPECT_EQ(found.notes.size(), texts_of(found).size() + 1);
  }
}

TEST(NoiseStream, SaysThatTheNoiseChanges) {
  std::vector<double> y = white_and_random_walk(50'000);
  for (std::size_t k = 25'000; k < y.size(); ++k) y[k] *= 1.5;
  const NoiseAnalysis found = in_pieces(y, {.rate_hz = 100.0}).value();
  EXPECT_TRUE(found.stationarity.tested);
  EXPECT_FALSE(found.stationarity.stationary);
  ASSERT_FALSE(found.notes.empty());
  EXPECT_EQ(found.notes.front().text.find("not stationary"), 0U);
}

TEST(NoiseStream, UsesTheRateKnownAtTheEnd) {
  const std::vector<double> y = white_and_random_walk(50'000);
  const NoiseAnalysis found = in_pieces(y, {.rate_hz = 100.0}, {.rate_hz = 99.0}).value();
  const NoiseAnalysis whole = analyse_noise(y, {.rate_hz = 99.0}).value();
  EXPECT_EQ(found.rate_hz, 99.0);
  EXPECT_EQ(found.duration_s, whole.duration_s);
  EXPECT_NEAR(found.model.white.value / whole.model.white.value, 1.0, 1e-9);
  EXPECT_NEAR(found.model.random_walk.value / whole.model.random_walk.value, 1.0, 1e-6);
  ASSERT_EQ(found.spectrum.one_sided_psd.size(), whole.spectrum.one_sided_psd.size());
  for (std::size_t k = 0; k < whole.spectrum.one_sided_psd.size(); ++k) {
    EXPECT_NEAR(found.spectrum.one_sided_psd[k] / whole.spectrum.one_sided_psd[k], 1.0, 1e-9);
    EXPECT_NEAR(found.spectrum.frequency_hz[k], whole.spectrum.frequency_hz[k], 1e-9);
  }
  ASSERT_EQ(found.deviation.points.size(), whole.deviation.points.size());
  for (std::size_t k = 0; k < whole.deviation.points.size(); ++k)
    EXPECT_NEAR(found.deviation.points[k].tau_s / whole.deviation.points[k].tau_s, 1.0, 1e-12);
}

void expect_refused(const NoiseOptions& options, const std::string& part) {
  const auto stream = NoiseStream::start(options);
  ASSERT_FALSE(stream) << part;
  EXPECT_EQ(stream.error().code, Errc::invalid_argument);
  EXPECT_NE(stream.error().message.find(part), std::string::npos) << stream.error().message;
  EXPECT_EQ(stream.error().message.find('\n'), std::string::npos);
}

TEST(NoiseStream, SaysWhatNeedsTheWholeRecordAndWhatToDo) {
  for (const Statistic statistic :
       {Statistic::adev, Statistic::hdev, Statistic::totdev, Statistic::mtotdev, Statistic::ttotdev,
        Statistic::htotdev, Statistic::theo1, Statistic::pdev})
    expect_refused({.rate_hz = 100.0, .statistic = statistic},
                   "or choose oadev, mdev, tdev or ohdev");
  expect_refused({.rate_hz = 100.0, .taus = {.kind = TauGrid::Kind::all}}, "choose octave");
  expect_refused({.rate_hz = 100.0, .noise_type = NoiseTypeSource::lag1}, "lag 1");
  expect_refused({.rate_hz = 100.0, .exclude_events = true}, "analyse a part");
  const auto stream = NoiseStream::start({.rate_hz = 100.0, .exclude_events = true});
  ASSERT_EQ(stream.error().advice.size(), 2u);
  EXPECT_EQ(stream.error().advice[0].option, "from");
  EXPECT_EQ(stream.error().advice[1].option, "to");
  expect_refused({.rate_hz = 100.0, .kind = SeriesKind::phase}, "phase");
  expect_refused(
      {.rate_hz = 1000.0, .taus = {.kind = TauGrid::Kind::given, .times_s = {99999.999}}},
      "99999999 samples");
  expect_refused({.rate_hz = 0.0}, "rate_hz must be positive");
}

TEST(NoiseStream, RefusesWhatTheAnalysisOfTheWholeRefuses) {
  std::vector<double> clipped = white_and_random_walk(20'000), coarse = clipped;
  for (double& x : clipped) x = std::clamp(x, 8.0, 11.0);
  for (double& x : coarse) x = std::round(x / 5.0) * 5.0;
  const std::vector<double> constant(1000, 1.0), nothing(1000, std::nan(""));
  const auto expect_same = [](const std::vector<double>& y, std::optional<double> lsb) {
    const auto found = in_pieces(y, {.rate_hz = 100.0}, {.lsb = lsb});
    const auto whole = analyse_noise(y, {.rate_hz = 100.0, .lsb = lsb});
    ASSERT_FALSE(found);
    ASSERT_FALSE(whole);
    EXPECT_EQ(found.error().message, whole.error().message);
    EXPECT_EQ(found.error().code, whole.error().code);
  };
  expect_same(clipped, {});
  expect_same(coarse, 5.0);
  expect_same(constant, {});
  expect_same(nothing, {});
  expect_same({1.0, 2.0}, {});
}

TEST(RecordOverview, IsTheSameHoweverTheSeriesIsCut) {
  std::vector<double> y = white_and_random_walk(10'000);
  y[77] = y[5000] = std::nan("");
  RecordOverview whole, pieces;
  whole.add(y);
  for (std::size_t from = 0, size = 1; from < y.size(); from += size, size = size * 7 % 101 + 1)
    pieces.add(View<double>(y).subspan(from, std::min(size, y.size() - from)));
  EXPECT_EQ(pieces.mean(), whole.mean());
  EXPECT_EQ(pieces.short_term_std(), whole.short_term_std());
  EXPECT_EQ(pieces.missing(), 2U);
}

TEST(RecordOverview, TakesTheEndsOfALongQuantisedNoiseForNoRails) {
  std::mt19937_64 rng(3);
  std::normal_distribution<double> normal(0.0, 4.0);
  RecordOverview overview;
  std::vector<double> y(4096);
  for (int piece = 0; piece < 1000; ++piece) {
    for (double& x : y) x = std::round(normal(rng));
    overview.add(y);
  }
  EXPECT_TRUE(overview.check_rails(1.0));
  // A sensor whose values stay within one and a half standard deviations.
  overview = RecordOverview();
  for (int piece = 0; piece < 200; ++piece) {
    for (double& x : y) x = std::min(std::round(normal(rng)), 6.0);
    overview.add(y);
  }
  ASSERT_FALSE(overview.check_rails(1.0));
  EXPECT_NE(overview.check_rails(1.0).error().message.find("the highest value"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::characterise::noise_stream_test
