#include "observer_comparison.hpp"

#include <gtest/gtest.h>

namespace proofmass::servo_comparison {
namespace {

// While the gap is crossed the smooth dead zone's intervals hold, and its angle is better than that
// of a bank of contact hypotheses: a load that overruns the motor is at none of its contacts.
TEST(MotorObserver, IsTrueWhileTheGapIsCrossed) {
  for (const Scenario& scenario : scenarios()) {
    const Comparison found = compare(scenario, 4);
    EXPECT_GT(found.smooth.coverage_95, 0.93) << scenario.name;
    EXPECT_LT(found.smooth.largest_z, 20.0) << scenario.name;
    if (!scenario.is_slow) {
      EXPECT_LT(found.smooth.rms_rad, 0.6 * found.bank.rms_rad) << scenario.name;
    }
  }
}

}  // namespace
}  // namespace proofmass::servo_comparison
