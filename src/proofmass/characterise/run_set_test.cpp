#include "proofmass/characterise/run_set.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/characterise/runs/run_test_support.hpp"

namespace proofmass::characterise::run_set_test {
namespace {

bool says(const RunSet& set, const std::string& text) {
  return std::ranges::any_of(
      set.notes, [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

void warm_up(test::MadeRuns& made, double amplitude, double time_constant_s, double rate_hz) {
  for (test::Series& y : made.series)
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] -= amplitude * std::exp(-static_cast<double>(k) / rate_hz / time_constant_s);
  test::make_views(made, rate_hz);
}

TEST(RunSet, HasTheMeansThatTheSamplesHave) {
  const test::MadeRuns made = test::made_of({.runs = 5, .between_std = 1.0});
  const RunSet set = compare_runs(made.runs, {}).value();
  EXPECT_DOUBLE_EQ(set.duration_s, 64.0);
  EXPECT_DOUBLE_EQ(set.window_s, 4.0);
  for (std::size_t i = 0; i < 5; ++i) {
    double first = 0.0, all = 0.0, last = 0.0;
    for (std::size_t k = 0; k < 512; ++k) {
      all += made.series[i][k] / 512.0;
      if (k < 32) first += made.series[i][k] / 32.0;
      if (k >= 480) last += made.series[i][k] / 32.0;
    }
    EXPECT_EQ(set.runs[i].name, made.runs[i].name);
    EXPECT_NEAR(set.runs[i].mean.value, all, 1e-12);
    EXPECT_NEAR(set.runs[i].turn_on.value, first, 1e-12);
    EXPECT_NEAR(set.runs[i].change.value, last - first, 1e-12);
    EXPECT_NEAR(set.runs[i].mean.std, set.level.within_std, 1e-12);
  }
}

TEST(RunSet, FindsTheWarmUpThatNoSingleRunShows) {
  test::MadeRuns made = test::made_of({.runs = 60, .samples = 2400, .rate_hz = 8.0, .seed = 7});
  warm_up(made, 2.4, 40.0, 8.0);
  const RunSet set = compare_runs(made.runs, {}).value();
  ASSERT_TRUE(set.warm_up.fit.identified) << set.warm_up.fit.reason;
  EXPECT_LE(*set.warm_up.fit.time_constant_s->lower_95, 40.0);
  EXPECT_GE(*set.warm_up.fit.time_constant_s->upper_95, 40.0);
  EXPECT_GT(set.change.mean, 4.0 * set.change.mean_std);
  int alone = 0;
  for (int i = 0; i < 5; ++i) {
    const auto single =
        analyse_drift(made.series[static_cast<std::size_t>(i)], {.rate_hz = 8.0}).value();
    alone += single.fit.identified ? 1 : 0;
  }
  EXPECT_EQ(alone, 0);
  EXPECT_FALSE(set.warm_up.notes.empty());
}

TEST(RunSet, NamesTheRunThatIsTooShort) {
  test::MadeRuns made = test::made_of({.runs = 4});
  made.series[2].resize(100);
  test::make_views(made, 8.0);
  const auto found = compare_runs(made.runs, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::too_few_samples);
  EXPECT_NE(found.error().message.find("run3"), std::string::npos);
}

TEST(RunSet, NamesTheRunOfAnotherRate) {
  test::MadeRuns made = test::made_of({.runs = 4});
  made.runs[1].rate_hz = 9.0;
  const auto found = compare_runs(made.runs, {});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::invalid_argument);
  EXPECT_NE(found.error().message.find("run2"), std::string::npos);
}

TEST(RunSet, OfTwoRunsIsNone) {
  const test::MadeRuns made = test::made_of({.runs = 2});
  EXPECT_EQ(compare_runs(made.runs, {}).error().code, Errc::too_few_samples);
}

TEST(RunSet, NamesAnOutlyingRunAndKeepsIt) {
  test::MadeRuns made = test::made_of({.runs = 10, .between_std = 0.5});
  for (double& y : made.series[4]) y += 20.0;
  const RunSet set = compare_runs(made.runs, {}).value();
  EXPECT_TRUE(says(set, "run5 is"));
  EXPECT_EQ(set.runs.size(), 10U);
  EXPECT_GT(set.level.observed_std, 5.0);
}

TEST(RunSet, NamesTheRunThatIsNoisier) {
  test::MadeRuns made = test::made_of({.runs = 10});
  for (double& y : made.series[6]) y *= 5.0;
  const RunSet set = compare_runs(made.runs, {}).value();
  EXPECT_TRUE(says(set, "run7 is noisier"));
  EXPECT_FALSE(says(set, "run2 is noisier"));
}

TEST(RunSet, DetectsATrendOverTheRuns) {
  test::MadeRuns made = test::made_of({.runs = 12, .between_std = 0.1});
  for (std::size_t i = 0; i < 12; ++i)
    for (double& y : made.series[i]) y += 0.3 * static_cast<double>(i);
  const RunSet set = compare_runs(made.runs, {}).value();
  EXPECT_NEAR(set.trend_per_run->value, 0.3, 4.0 * set.trend_per_run->std);
  EXPECT_LT(set.trend_p, 1e-4);
  EXPECT_TRUE(says(set, "rises from run to run"));
}

// 60 power-ups whose means follow −2.4 (1 − e^(−n/5.2)), with a scatter of 0.14 between runs.
TEST(RunSet, FindsTheWarmUpThatGoesOnFromRunToRun) {
  int held = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    test::MadeRuns made = test::made_of({.runs = 60, .between_std = 0.1, .seed = seed});
    for (std::size_t i = 0; i < 60; ++i)
      for (double& y : made.series[i]) y -= 2.4 * (1.0 - std::exp(-static_cast<double>(i) / 5.2));
    const RunSet set = compare_runs(made.runs, {}).value();
    ASSERT_TRUE(set.level_curve);
    if (!set.level_curve->identified) continue;
    const Interval95& T = *set.level_curve->time_constant_s;
    EXPECT_NEAR(T.value, 5.2, 4.0 * T.std);
    EXPECT_LT(T.std, 0.8);
    EXPECT_NEAR(set.level_curve->a1->value, -2.4, 4.0 * set.level_curve->a1->std);
    EXPECT_NEAR(set.level_curve->a2.value, 0.0, 4.0 * set.level_curve->a2.std);
    held += *T.lower_95 <= 5.2 && 5.2 <= *T.upper_95 ? 1 : 0;
  }
  EXPECT_GE(held, 2);
}

TEST(RunSet, FindsNoWarmUpOverRunsThatOnlyScatter) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const test::MadeRuns made = test::made_of({.runs = 30, .between_std = 0.3, .seed = seed});
    const RunSet set = compare_runs(made.runs, {}).value();
    ASSERT_TRUE(set.level_curve);
    EXPECT_FALSE(set.level_curve->identified);
    EXPECT_FALSE(set.level_curve->reason.empty());
  }
}

TEST(RunSet, OfFewerThanTwelveRunsHasNoCurveOverThem) {
  const test::MadeRuns made = test::made_of({.runs = 11, .between_std = 0.3});
  EXPECT_FALSE(compare_runs(made.runs, {}).value().level_curve);
}

TEST(RunSet, ComparesOverTheShortestRunAndSaysWhich) {
  test::MadeRuns made = test::made_of({.runs = 4});
  made.series[1].resize(400);
  test::make_views(made, 8.0);
  const RunSet set = compare_runs(made.runs, {}).value();
  EXPECT_DOUBLE_EQ(set.duration_s, 50.0);
  EXPECT_TRUE(says(set, "the length of run2"));
}

}  // namespace
}  // namespace proofmass::characterise::run_set_test
