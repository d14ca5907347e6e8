#include "proofmass/estimate/tune_choice.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::estimate::tune_choice_test {
namespace {

constexpr double rate_hz = 100.0;

/// White noise at rest, with strong vibration in the last part of the samples.
std::vector<double> moving_at_the_end(std::size_t samples, double moving_share) {
  Random random(3, "tune choice");
  std::vector<double> values;
  const auto still = static_cast<std::size_t>((1.0 - moving_share) * static_cast<double>(samples));
  for (std::size_t k = 0; k < samples; ++k) {
    const double t_s = static_cast<double>(k) / rate_hz;
    values.push_back(9.8 + 0.01 * random.normal() + (k < still ? 0.0 : 5.0 * std::sin(3.0 * t_s)));
  }
  return values;
}

TuneChoice choice_of(const std::vector<double>& values, TuneChoiceOptions options) {
  const std::vector<View<double>> axes{values};
  options.rate_hz = rate_hz;
  return choose_tune_model(axes, options);
}

TEST(ChooseTuneModel, TakesTheWholeRecordingWhereAllOfItIsAtRest) {
  const TuneChoice choice = choice_of(moving_at_the_end(6000, 0.0), {});
  EXPECT_EQ(choice.model, TuneModel::rest);
  EXPECT_EQ(choice.basis, TuneBasis::at_rest);
  EXPECT_GT(choice.rest_share.value(), 0.99);
}

TEST(ChooseTuneModel, LeavesOutTheMotionOfARecordingNearlyAtRest) {
  const std::vector<double> values = moving_at_the_end(6000, 0.05);
  const TuneChoice choice = choice_of(values, {});
  EXPECT_EQ(choice.basis, TuneBasis::at_rest);
  ASSERT_FALSE(choice.rests.empty());
  EXPECT_LT(choice.rests.back().last, 5700U);
}

TEST(ChooseTuneModel, IsAModelOfMotionWhereMuchOfItMoves) {
  const TuneChoice choice = choice_of(moving_at_the_end(6000, 0.4), {});
  EXPECT_EQ(choice.model, TuneModel::pva);
  EXPECT_EQ(choice.basis, TuneBasis::in_motion);
  EXPECT_NEAR(choice.rest_share.value(), 0.6, 0.02);
  EXPECT_TRUE(choice.rests.empty());
}

TEST(ChooseTuneModel, CountsAGapNeitherAsRestNorAsMotion) {
  std::vector<double> values = moving_at_the_end(6000, 0.0);
  values.insert(values.begin() + 3000, 9000, std::numeric_limits<double>::quiet_NaN());
  const TuneChoice choice = choice_of(values, {});
  EXPECT_EQ(choice.model, TuneModel::rest);
  EXPECT_GT(choice.rest_share.value(), 0.99);
}

TEST(ChooseTuneModel, TunesAGivenModelOfRestOnTheStaticIntervals) {
  const TuneChoice choice =
      choice_of(moving_at_the_end(6000, 0.4), {.given = TuneModel::rest_markov});
  EXPECT_EQ(choice.model, TuneModel::rest_markov);
  EXPECT_EQ(choice.basis, TuneBasis::given);
  ASSERT_EQ(choice.rests.size(), 1U);
  EXPECT_LT(choice.rests.front().last, 3600U);
}

TEST(ChooseTuneModel, TunesAGivenModelOfMotionOnAllSamples) {
  const TuneChoice choice = choice_of(moving_at_the_end(6000, 0.4), {.given = TuneModel::pva});
  EXPECT_EQ(choice.model, TuneModel::pva);
  EXPECT_FALSE(choice.rest_share);
  EXPECT_TRUE(choice.rests.empty());
}

TEST(ChooseTuneModel, IsALocalLevelWhereNoAccelerationIsMeasured) {
  const TuneChoice choice =
      choice_of(moving_at_the_end(600, 0.0), {.measures_acceleration = false});
  EXPECT_EQ(choice.model, TuneModel::local_level);
  EXPECT_EQ(choice.basis, TuneBasis::no_acceleration);
}

TEST(TuneSeriesOfAChoice, HasOneSegmentForEachRestWithItsTime) {
  const std::vector<double> values{0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  TuneChoice choice;
  choice.rests = {{1, 2}, {4, 5}};
  const TuneSeries series = tune_series("x", 2.0, values, choice);
  ASSERT_EQ(series.segments.size(), 2U);
  EXPECT_EQ(series.segments[0].size(), 2U);
  EXPECT_EQ(series.segments[1][0], 4.0);
  EXPECT_EQ(series.starts_s, (std::vector<double>{0.5, 2.0}));
  EXPECT_EQ(tune_series("x", 2.0, values, {}).segments.front().size(), values.size());
}

}  // namespace
}  // namespace proofmass::estimate::tune_choice_test
