#include "proofmass/estimate/gain_study.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::estimate::gain_study_test {
namespace {

// The thesis's simulation: 100 s in steps of 0.2 s from P₀ = 100.
GainStudy thesis(double q, double R) {
  return gain_study({.jerk_psd_m2ps5 = q,
                     .accel_variance_m2ps4 = R,
                     .step_s = 0.2,
                     .duration_s = 100.0,
                     .prior_variance = 100.0});
}

TEST(GainStudy, EndsAtTheLimitsThatItStates) {
  for (const auto& study : {thesis(4.0, 1.0), thesis(1.0, 4.0), thesis(1.0, 1.0)}) {
    const GainEpoch& last = study.epochs.back();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(last.gain[i] / study.limit[i], 1.0, 1e-6) << i;
    EXPECT_NEAR(last.variance[2] / study.limit_variance_m2ps4, 1.0, 1e-9);
  }
}

TEST(GainStudy, LargerQThanRSettlesWithinTwoSeconds) {
  const GainStudy study = thesis(4.0, 1.0);
  for (const auto& time_s : study.settling_s) {
    ASSERT_TRUE(time_s.has_value());
    EXPECT_LE(*time_s, 2.0);
  }
}

TEST(GainStudy, LargerRThanQTakesSeveralTimesAsLong) {
  const GainStudy study = thesis(1.0, 4.0);
  EXPECT_NEAR(study.limit[2], 0.2, 1e-12);  // (√(0.05² + 0.2) − 0.05)/2
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(study.settling_s[i].has_value());
    EXPECT_GT(*study.settling_s[i], 2.0 * *thesis(4.0, 1.0).settling_s[i]);
  }
}

TEST(GainStudy, SettlesTheLaterTheLessIsForgiven) {
  const GainStudy study = thesis(1.0, 4.0);
  EXPECT_EQ(settling_s(study, 0, 0.02), study.settling_s[0]);
  EXPECT_GT(settling_s(study, 0, 1e-3).value(), study.settling_s[0].value());
  // Each step reduces the distance of the gain from its limit by (1 − k)², k = 0.2.
  const double tenth_s = settling_s(study, 2, 1e-4).value() - settling_s(study, 2, 1e-3).value();
  EXPECT_NEAR(tenth_s, 0.2 * std::log(0.1) / (2.0 * std::log(0.8)), 0.2);
}

TEST(GainStudy, AGainThatDoesNotGetThereHasNoSettlingTime) {
  const GainStudy study = gain_study({.jerk_psd_m2ps5 = 1e-6, .duration_s = 2.0});
  EXPECT_FALSE(study.settling_s[2].has_value());
}

TEST(GainStudy, WhatIsNotObservedGrows) {
  const GainStudy study = thesis(1.0, 1.0);
  EXPECT_GT(study.epochs.back().variance[0], 3.0 * study.epochs[250].variance[0]);
  EXPECT_GT(study.epochs.back().variance[1], study.epochs[250].variance[1]);
}

TEST(GainStudy, ALongerStepMakesTheGainLargerAndTheEstimateWorse) {
  const std::vector<double> steps{0.01, 0.1, 1.0, 10.0};
  const auto effects = step_size_study({}, steps);
  ASSERT_EQ(effects.size(), steps.size());
  for (std::size_t k = 1; k < effects.size(); ++k) {
    EXPECT_GT(effects[k].gain, effects[k - 1].gain);
    EXPECT_GT(effects[k].accel_std_mps2, effects[k - 1].accel_std_mps2);
    EXPECT_GT(effects[k].predicted_std_mps2, effects[k].accel_std_mps2);
  }
  // k → 1 for measurements so rare that they are independent.
  EXPECT_NEAR(effects.back().accel_std_mps2, 1.0, 0.1);
}

}  // namespace
}  // namespace proofmass::estimate::gain_study_test
