#include "proofmass/estimate/tune_study.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::estimate::tune_study_test {
namespace {

/// A tuning with given noise densities of measurement and level, and R.
Tuning tuning_with(double white, double random_walk, double R) {
  TunedSeries series;
  series.name = "x";
  series.rate_hz = 10.0;
  series.values = {white, random_walk};
  series.system.R = R;
  Tuning tuning;
  tuning.series = {series};
  return tuning;
}

// The scalar Riccati equation iterated: P⁻ = P⁺ + W, k = P⁻/(P⁻ + R), P⁺ = R k.
double limit_of_gain(double W, double R) {
  double P = R;
  for (int n = 0; n < 100'000; ++n) P = R * (P + W) / (P + W + R);
  return P / R;
}

TEST(TuneStudy, HasTheLimitOfTheRiccatiEquationForEachCase) {
  const double K = 0.02, R = 0.04, step_s = 0.1;
  const TuneStudy study = tune_study(tuning_with(0.1, K, R), 0).value();
  EXPECT_EQ(study.channel, "x");
  ASSERT_EQ(study.cases.size(), 3U);
  const double W = K * K * step_s;
  EXPECT_NEAR(study.cases[0].study.limit[2], limit_of_gain(W, R), 1e-9);
  EXPECT_NEAR(study.cases[1].study.limit[2], limit_of_gain(4.0 * W, R), 1e-9);
  EXPECT_NEAR(study.cases[2].study.limit[2], limit_of_gain(W, 4.0 * R), 1e-9);
}

TEST(TuneStudy, LastsUntilTheGainOfEachCaseHasSettled) {
  const TuneStudy study = tune_study(tuning_with(0.1, 0.02, 0.04), 0).value();
  for (const GainCase& one : study.cases) EXPECT_TRUE(one.study.settling_s[2].has_value());
}

TEST(TuneStudy, TakesStepsFromTheGivenOneOn) {
  const TuneStudy study = tune_study(tuning_with(0.1, 0.02, 0.04), 0, 0.5).value();
  ASSERT_EQ(study.steps.size(), 6U);
  EXPECT_EQ(study.steps.front().step_s, 0.5);
  EXPECT_EQ(study.steps.back().step_s, 25.0);
}

TEST(TuneStudy, IsAbsentWithoutTwoNoises) {
  EXPECT_FALSE(tune_study(tuning_with(0.1, 0.0, 0.04), 0));
  Tuning other = tuning_with(0.1, 0.02, 0.04);
  other.model = TuneModel::local_trend;
  EXPECT_FALSE(tune_study(other, 0));
}

}  // namespace
}  // namespace proofmass::estimate::tune_study_test
