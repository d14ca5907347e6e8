#include "proofmass/acquire/clock/rate_watch.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "proofmass/acquire/recorder/record_test_support.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"

namespace proofmass::acquire::rate_watch_test {
namespace {

/// Output of a watch for rows at `rate_hz` in tenths of a second, each `late_s` late.
std::vector<OtherRate> reported_of(double granted_hz,
                                   double rate_hz,
                                   const std::function<double(double time_s)>& late_s) {
  RateWatch watch(granted_hz);
  std::vector<OtherRate> reported;
  for (double time_s = 0.1; time_s < 120.0; time_s += 0.1)
    if (const auto other =
            watch.add(static_cast<std::uint64_t>(time_s * rate_hz), time_s + late_s(time_s)))
      reported.push_back(*other);
  return reported;
}

double in_time(double) {
  return 0.0;
}

TEST(RateWatch, TellsOnceAtWhichRateRowsCome) {
  for (const double rate_hz : {50.0, 94.0, 106.0, 400.0}) {
    const auto reported = reported_of(100.0, rate_hz, in_time);
    ASSERT_EQ(reported.size(), 1u) << rate_hz;
    EXPECT_NEAR(reported[0].rate_hz, rate_hz, 0.01 * rate_hz);
    EXPECT_NEAR(reported[0].for_s, 15.0, 0.5);
  }
}

TEST(RateWatch, TakesTheGrantedRateForWhatItIs) {
  std::mt19937_64 random(4);
  std::exponential_distribution<double> delay(20.0);
  for (const double rate_hz : {96.0, 100.0, 104.0})
    EXPECT_TRUE(reported_of(100.0, rate_hz, [&](double) { return delay(random); }).empty());
  EXPECT_TRUE(reported_of(0.0, 50.0, in_time).empty()) << "none was granted";
}

TEST(RateWatch, IsNotMisledByADelayAndWhatMakesUpForIt) {
  // From second 20 nothing arrives for 9 s, and then everything at once.
  const auto held_up = [](double time_s) {
    return time_s > 20.0 && time_s < 29.0 ? 29.0 - time_s : 0.0;
  };
  EXPECT_TRUE(reported_of(100.0, 100.0, held_up).empty());
}

TEST(RateWatch, WaitsForEnoughOfSlowRows) {
  RateWatch watch(0.1);
  for (int k = 1; k < 100; ++k) EXPECT_FALSE(watch.add(static_cast<std::uint64_t>(k), 9.0 * k));
  int reported = 0;
  for (int k = 100; k < 200; ++k)
    reported += watch.add(static_cast<std::uint64_t>(k), 9.0 * k) ? 1 : 0;
  EXPECT_EQ(reported, 1);
}

TEST(Recorder, TellsThatRowsComeAtAnotherRateThanTheGranted) {
  const TestFolder folder;
  for (const bool has_device_clock : {true, false}) {
    Script script{.acts = arrivals(200), .has_device_clock = has_device_clock, .is_paced = true};
    // 100 Hz were granted, the actual rate is 80 Hz.
    const auto at = [](std::uint64_t row) { return static_cast<std::int64_t>(row) * 12'500'000; };
    script.device_ns = script.host_ns = at;
    const auto summary =
        record(open_scripts({script}), {.path = folder.file(has_device_clock ? "a" : "b")});
    ASSERT_TRUE(summary) << summary.error().message;
    ASSERT_EQ(summary->events.size(), 1u);
    EXPECT_EQ(summary->events[0].severity, Severity::warning);
    EXPECT_EQ(summary->events[0].text,
              std::string("rows have come at 80 Hz for 15 s, not at the granted 100 Hz") +
                  (has_device_clock ? "" : ", by which their times are counted"));
  }
}

}  // namespace
}  // namespace proofmass::acquire::rate_watch_test
