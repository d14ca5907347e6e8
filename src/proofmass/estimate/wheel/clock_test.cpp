#include "proofmass/estimate/wheel/clock.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/wheel_test_support.hpp"

namespace proofmass::estimate::wheel_clock_test {
namespace {

using test::Drive;
using test::Normal;
using test::rpm;

/// A motion as measured by one sensor: with its own clock, at angle `phase`, with white noise.
struct Seen {
  std::vector<double> time_s, angle_rad, speed_radps;

  Seen(const Drive& drive,
       double clock_offset_s,
       double phase_rad,
       double error,
       std::uint64_t seed) {
    Normal normal(seed);
    for (double t = 0.0; t <= drive.duration_s(); t += 0.01) {
      const test::Turning now = drive.at(t);
      time_s.push_back(t + clock_offset_s);
      angle_rad.push_back(now.angle_rad + phase_rad + error * normal());
      speed_radps.push_back(now.speed_radps + error * normal());
    }
  }
  [[nodiscard]] WheelMotion motion() const { return {&time_s, &angle_rad, &speed_radps}; }
};

const Drive changing{{0.2, 0.0}, {{8.0, 60 * rpm}, {6.0, 60 * rpm}, {6.0, 10 * rpm}, {4.0, 0.0}}};

TEST(FitClocks, RecoversTheOffsetAndThePhaseOfTwoClocks) {
  const Seen first(changing, 0.0, 0.0, 1e-3, 1);
  for (const double offset : {-7.3, 0.0123, 5.5, 1234.5}) {
    const Seen second(changing, offset, 0.8, 1e-3, 2);
    const auto fit = fit_clocks(first.motion(), second.motion(), false);
    ASSERT_TRUE(fit.has_value()) << fit.error().message;
    EXPECT_NEAR(fit->offset_s.value, offset, std::max(4.0 * fit->offset_s.std, 1e-5));
    EXPECT_LT(fit->offset_s.std, 1e-3);
    EXPECT_NEAR(fit->phase_rad, 0.8, 1e-3);
  }
}

// What an estimate without measurements is in a gap: any speed, and an angle some turns off behind
// it.
TEST(FitClocks, IntervalsInWhichAnAngleWasLostDoNotCount) {
  Seen first(changing, 0.0, 0.0, 1e-3, 1);
  const Seen second(changing, 2.3, 0.8, 1e-3, 2);
  for (std::size_t k = 0; k < first.time_s.size(); ++k) {
    const double t = first.time_s[k];
    if (t > 9.0 && t < 13.0) first.speed_radps[k] = 60.0 * (t - 11.0);
    if (t > 11.0) first.angle_rad[k] += 10.0 * test::pi;
  }
  WheelMotion lost = first.motion();
  lost.lost = {{9.0, 13.0}};
  const auto fit = fit_clocks(lost, second.motion(), true);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->offset_s.value, 2.3, 1e-3);
  EXPECT_NEAR(fit->phase_rad, 0.8, 2e-3);
  EXPECT_GT(
      std::abs(fit_clocks(first.motion(), second.motion(), true).value().offset_s.value - 2.3),
      0.1);
}

TEST(FitClocks, OffsetIsWhatToTakeFromTheSecondsStamps) {
  const Seen first(changing, 0.0, 0.0, 0.0, 1), second(changing, 0.05, 0.0, 0.0, 2);
  EXPECT_NEAR(fit_clocks(first.motion(), second.motion(), false).value().offset_s.value, 0.05,
              1e-5);
}

TEST(FitClocks, OfOneClockFindsASmallOffsetAndLeavesALargeOneAlone) {
  const Seen first(changing, 0.0, 0.0, 1e-4, 1), near(changing, 0.02, -2.9, 1e-4, 2);
  const auto fit = fit_clocks(first.motion(), near.motion(), true);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->offset_s.value, 0.02, 1e-4);
  EXPECT_NEAR(fit->phase_rad, -2.9, 1e-3);
}

TEST(FitClocks, PhaseIsWithinHalfATurnWhateverTheCountOfTurns) {
  const Seen first(changing, 0.0, 0.0, 0.0, 1),
      second(changing, 0.0, 3.0 + 14.0 * test::pi, 0.0, 2);
  EXPECT_NEAR(fit_clocks(first.motion(), second.motion(), true).value().phase_rad, 3.0, 1e-6);
}

TEST(FitClocks, AtOneSpeedTwoClocksAreNotObservable) {
  const Drive steady{{0.0, 11 * rpm}, {{20.0, 11 * rpm}}};
  const Seen first(steady, 0.0, 0.0, 1e-3, 1), second(steady, 0.5, 0.3, 1e-3, 2);
  const auto fit = fit_clocks(first.motion(), second.motion(), false);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, Errc::not_observable);
  EXPECT_EQ(fit.error().message,
            "two clocks cannot be aligned at one speed: stop, start or change speed once");
}

TEST(FitClocks, AtOneSpeedOneClockGivesThePhaseAndNoOffset) {
  const Drive steady{{0.0, 11 * rpm}, {{20.0, 11 * rpm}}};
  const Seen first(steady, 0.0, 0.0, 1e-3, 1), second(steady, 0.0, 0.3, 1e-3, 2);
  const auto fit = fit_clocks(first.motion(), second.motion(), true);
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->offset_s.value, 0.0);
  EXPECT_NEAR(fit->phase_rad, 0.3, 1e-3);
}

TEST(FitClocks, FindsThatStampsOnOneClockAreNot) {
  const Seen first(changing, 0.0, 0.0, 1e-4, 1), second(changing, 2.5, 0.4, 1e-4, 2);
  const auto fit = fit_clocks(first.motion(), second.motion(), true);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->offset_s.value, 2.5, 1e-3);
  EXPECT_NEAR(fit->phase_rad, 0.4, 1e-3);
}

// At an acceleration of 0.1 rad/s² the speeds differ by 0.03 rad/s, too little to be noticed by
// itself.
TEST(FitClocks, FindsAThirdOfASecondBetweenSlowStamps) {
  const Drive slow{{0.2, 0.0}, {{5.0, 0.0}, {20.0, 2.0}, {20.0, 2.0}, {20.0, 0.0}}};
  const Seen first(slow, 0.0, 0.0, 1e-3, 1), second(slow, 0.3127, 0.4, 1e-3, 2);
  const auto fit = fit_clocks(first.motion(), second.motion(), true);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->offset_s.value, 0.3127, 1e-3);
  EXPECT_NEAR(fit->phase_rad, 0.4, 1e-3);
}

TEST(FitClocks, SaysThatTooLittleTimeIsShared) {
  const Drive brief{{0.0, 0.0}, {{0.5, 60 * rpm}}};
  const Seen first(brief, 0.0, 0.0, 0.0, 1), second(brief, 0.0, 0.0, 0.0, 2);
  const auto fit = fit_clocks(first.motion(), second.motion(), true);
  ASSERT_FALSE(fit.has_value());
  EXPECT_EQ(fit.error().code, Errc::not_observable);
  EXPECT_EQ(fit.error().message, "the two recordings share less than a second");
}

TEST(FitPhase, IsThePhaseWithoutAnOffset) {
  const Seen first(changing, 0.0, 0.0, 1e-4, 1), second(changing, 0.0, -2.9, 1e-4, 2);
  const auto fit = fit_phase(first.motion(), second.motion());
  ASSERT_TRUE(fit.has_value());
  EXPECT_EQ(fit->offset_s.value, 0.0);
  EXPECT_NEAR(fit->phase_rad, -2.9, 1e-4);
}

}  // namespace
}  // namespace proofmass::estimate::wheel_clock_test
