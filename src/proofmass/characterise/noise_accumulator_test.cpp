#include "proofmass/characterise/noise_accumulator.hpp"

#include <gtest/gtest.h>
#include <random>

namespace proofmass::characterise::noise_accumulator_test {
namespace {

std::vector<double> white_and_random_walk(std::size_t n) {
  std::mt19937_64 rng(11);
  std::normal_distribution<double> normal;
  std::vector<double> y(n);
  double walk = 9.8;
  for (double& v : y) v = normal(rng) + (walk += 0.01 * normal(rng));
  return y;
}

TEST(NoiseAccumulator, SaysTheSameWhateverPiecesTheSamplesComeIn) {
  const auto y = white_and_random_walk(60'000);
  const NoiseOptions options{.rate_hz = 100.0};
  NoiseAccumulator whole(options, y.size()), pieces(options, y.size());
  whole.add(y);
  for (std::size_t from = 0, size = 1; from < y.size(); from += size, size = size * 7 % 1009 + 1)
    pieces.add(View<double>(y).subspan(from, std::min(size, y.size() - from)));
  const NoiseAnalysis a = whole.finish(), b = pieces.finish();
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_NEAR(b.model.white.value / a.model.white.value, 1.0, 1e-9);
  EXPECT_NEAR(b.model.random_walk.value / a.model.random_walk.value, 1.0, 1e-6);
  ASSERT_EQ(a.deviation.points.size(), b.deviation.points.size());
  for (std::size_t k = 0; k < a.deviation.points.size(); ++k)
    EXPECT_NEAR(b.deviation.points[k].upper / a.deviation.points[k].upper, 1.0, 1e-6);
}

TEST(NoiseAccumulator, NeedsNotKnowHowLongTheRecordingWillBe) {
  const auto y = white_and_random_walk(300'000);
  const NoiseOptions options{.rate_hz = 100.0, .taus = {.kind = TauGrid::Kind::octave}};
  NoiseAccumulator foreseen(options, y.size()), unforeseen(options);
  foreseen.add(y);
  unforeseen.add(y);
  const NoiseAnalysis a = foreseen.finish(), b = unforeseen.finish();
  ASSERT_EQ(a.deviation.points.size(), b.deviation.points.size());
  EXPECT_EQ(b.deviation.points.back().m, 65'536U);
  for (std::size_t k = 0; k < a.deviation.points.size(); ++k)
    EXPECT_NEAR(b.deviation.points[k].value / a.deviation.points[k].value, 1.0, 0.03);
  EXPECT_NEAR(b.model.white.value / a.model.white.value, 1.0, 1e-9);
}

TEST(NoiseAccumulator, IsWhatAnalyseNoiseFolds) {
  const auto y = white_and_random_walk(20'000);
  const NoiseOptions options{.rate_hz = 100.0, .statistic = Statistic::mdev};
  NoiseAccumulator accumulator(options, y.size());
  accumulator.add(y);
  const NoiseAnalysis folded = accumulator.finish(), whole = analyse_noise(y, options).value();
  ASSERT_EQ(folded.deviation.points.size(), whole.deviation.points.size());
  for (std::size_t k = 0; k < whole.deviation.points.size(); ++k)
    EXPECT_EQ(folded.deviation.points[k].lower, whole.deviation.points[k].lower);
  EXPECT_EQ(folded.model.flicker.upper_95, whole.model.flicker.upper_95);
}

TEST(NoiseAccumulator, IsEmptyWithoutSamples) {
  const NoiseAccumulator empty({.rate_hz = 100.0});
  const NoiseAnalysis analysis = empty.finish();
  EXPECT_TRUE(analysis.deviation.points.empty());
  EXPECT_EQ(analysis.model.ordinates, 0U);
}

}  // namespace
}  // namespace proofmass::characterise::noise_accumulator_test
