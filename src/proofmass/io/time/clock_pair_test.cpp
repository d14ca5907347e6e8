#include "proofmass/io/time/clock_pair.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::clock_pair_test {
namespace {

/// A device's clock, and a computer's that is fast by `drift_ppm`, delayed by some milliseconds
/// with correlation between rows, and occasionally by a quarter of a second.
struct Clocks {
  std::vector<double> device_s;
  std::vector<double> host_s;
};
Clocks clocks(std::uint64_t seed, double drift_ppm, std::size_t rows = 20'000) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> late(1.0 / 0.004);
  std::bernoulli_distribution is_busy(0.01);
  Clocks out;
  double backlog_s = 0.0;
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    backlog_s = 0.7 * backlog_s + 0.3 * late(random) + (is_busy(random) ? 0.25 : 0.0);
    out.device_s.push_back(t);
    out.host_s.push_back(5.0 + t * (1.0 + 1e-6 * drift_ppm) + backlog_s);
  }
  return out;
}

TEST(ClockPair, FindsTheDriftOfAComputersClockThatIsLateNowAndThen) {
  const Clocks both = clocks(1, 40.0);
  const auto pair = compare_clocks(both.device_s, both.host_s);
  ASSERT_TRUE(pair.has_value());
  EXPECT_NEAR(pair->drift_ppm, 40.0, 3.0 * pair->drift_std_ppm);
  EXPECT_LT(pair->drift_std_ppm, 3.0);
  EXPECT_NEAR(pair->offset_s, 5.004, 0.003);
  EXPECT_LT(pair->base_jitter_s, 1e-9);
  EXPECT_GT(pair->other_jitter_s, 5e-4);
}

TEST(ClockPair, CoversTheTrueDriftNineteenTimesInTwenty) {
  int inside = 0;
  const int trials = 150;
  for (int i = 0; i < trials; ++i) {
    const Clocks both = clocks(100 + static_cast<std::uint64_t>(i), -25.0, 4096);
    const auto pair = compare_clocks(both.device_s, both.host_s);
    ASSERT_TRUE(pair.has_value());
    if (std::abs(pair->drift_ppm + 25.0) < 1.96 * pair->drift_std_ppm) ++inside;
  }
  EXPECT_NEAR(static_cast<double>(inside) / trials, 0.95, 0.035);
}

TEST(ClockPair, IsExactWithoutNoise) {
  std::vector<double> base_s;
  std::vector<double> other_s;
  for (int k = 0; k < 1000; ++k) {
    base_s.push_back(k);
    other_s.push_back(3.0 + k * (1.0 - 100e-6));
  }
  const auto pair = compare_clocks(base_s, other_s);
  ASSERT_TRUE(pair.has_value());
  EXPECT_NEAR(pair->drift_ppm, -100.0, 1e-6);
  EXPECT_LT(pair->drift_std_ppm, 1e-6);
  EXPECT_NEAR(pair->offset_s, 3.0, 1e-9);
}

TEST(ClockPair, RefusesTooLittleAndAClockThatStandsStill) {
  const std::vector<double> few(63, 1.0);
  const std::vector<double> same(100, 1.0);
  EXPECT_EQ(compare_clocks(few, few).error().code, Errc::too_few_samples);
  EXPECT_EQ(compare_clocks(same, same).error().code, Errc::not_observable);
  const std::vector<double> none(100, std::nan(""));
  EXPECT_EQ(compare_clocks(none, same).error().code, Errc::too_few_samples);
}

TEST(ClockPair, OfARecordingIsToldAndDatesIt) {
  const Clocks both = clocks(3, 40.0, 2000);
  Recording recording;
  recording.time.source = TimeSource::stamps;
  recording.time.channel = "tick";
  recording.time.rate_hz = 100.0;
  recording.time.start_ns = 0;
  recording.channels = {{"host_time", {}, {}}, {"a", {}, std::vector<double>(2000, 1.0)}};
  for (const double t : both.host_s)
    recording.channels[0].values.edit().push_back(std::round(1.705479286e12 + 1e3 * t));
  note_other_clocks(recording);
  ASSERT_EQ(recording.notes.size(), 1u);
  EXPECT_TRUE(is_noted(recording, "host_time against tick: ")) << notes_of(recording);
  EXPECT_TRUE(is_noted(recording, "the date of the first sample is taken from it"));
  EXPECT_NEAR(static_cast<double>(*recording.time.start_ns - 1'705'479'291'000'000'000), 0.0, 5e8);
}

TEST(ClockPair, IsNotLookedForAmongReadings) {
  Recording recording;
  recording.time.source = TimeSource::stamps;
  recording.time.channel = "t";
  recording.time.rate_hz = 100.0;
  recording.channels = {{"ax", {}, {}}, {"PacketCounter", {}, {}}, {"runtime", {}, {}}};
  for (int k = 0; k < 500; ++k) {
    recording.channels[0].values.edit().push_back(0.01 * k);
    recording.channels[1].values.edit().push_back(k);
    recording.channels[2].values.edit().push_back(k % 7);
  }
  note_other_clocks(recording);
  EXPECT_TRUE(recording.notes.empty()) << notes_of(recording);
}

}  // namespace
}  // namespace proofmass::io::clock_pair_test
