#include "proofmass/servo/study.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::servo {
namespace {

const ServoRun& worst(const ServoStudy& study, Feedback feedback, bool compensated) {
  for (const ServoRun& run : study.worst)
    if (run.feedback == feedback && run.compensated == compensated) return run;
  ADD_FAILURE() << "no run of " << name_of(feedback);
  return study.worst.front();
}

// The answer to the thesis's question: the estimate holds the speed with less ripple than gravity's
// angle alone, and a double integration holds nothing.
TEST(ServoStudy, TheEstimateDrivesTheMotorAndDoubleIntegrationDoesNot) {
  const ServoStudy study = study_servo({.seeds = 3}).value();
  EXPECT_EQ(study.runs.size(), 24U);
  EXPECT_EQ(study.worst.size(), 8U);
  EXPECT_NEAR(study.model.torque_constant_nmpa, 22.6, 0.3);
  const ServoRun& live = worst(study, Feedback::live_estimate, true);
  const ServoRun& atan2 = worst(study, Feedback::atan2, true);
  const ServoRun& encoder = worst(study, Feedback::encoder, true);
  ASSERT_TRUE(live.speed_settling_s && encoder.speed_settling_s);
  EXPECT_LT(*live.speed_settling_s, 2.0);
  EXPECT_LT(live.speed_ripple_radps, 0.3 * atan2.speed_ripple_radps);
  EXPECT_LT(live.speed_error_radps, 0.02);
  const ServoRun& integrated = worst(study, Feedback::double_integration, true);
  EXPECT_FALSE(integrated.speed_settling_s);
  EXPECT_FALSE(integrated.position_settling_s);
  ASSERT_TRUE(encoder.position_settling_s);
}

// With more delay the loop answers later, and still settles: the gains know the delay.
TEST(ServoStudy, TheDelayOfTheChainIsPartOfTheDesign) {
  const ServoStudy soon = study_servo({.seeds = 1, .delay_samples = 1}).value();
  const ServoStudy late = study_servo({.seeds = 1, .delay_samples = 10}).value();
  const auto settling = [](const ServoStudy& study) {
    return worst(study, Feedback::encoder, true).speed_settling_s;
  };
  ASSERT_TRUE(settling(soon) && settling(late));
  EXPECT_GT(*settling(late), *settling(soon));
}

TEST(ServoStudy, RefusesWhatIsNoLoop) {
  EXPECT_EQ(study_servo({.rate_hz = 0.0}).error().code, Errc::invalid_argument);
  EXPECT_EQ(study_servo({.delay_samples = 0}).error().code, Errc::invalid_argument);
  EXPECT_EQ(study_servo({.seeds = 0}).error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace proofmass::servo
