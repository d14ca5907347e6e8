#include "proofmass/acquire/clock/sample_period.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "proofmass/acquire/clock/time_line.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::acquire::usual_step_test {
namespace {

constexpr double tick_s = 0.01;

/// A clock that ticks and skips ticks at random; each interval has an error of `jitter` ticks.
class SkippingClock {
 public:
  SkippingClock(double skips, double jitter, std::uint64_t seed)
      : skips_(skips), jitter_(jitter), random_(seed) {}
  double next_s() {
    do ++tick_;
    while (unit_(random_) < skips_);
    return tick_s * (static_cast<double>(tick_) + jitter_ * normal_(random_));
  }
  [[nodiscard]] std::uint64_t ticks() const { return tick_; }

 private:
  double skips_, jitter_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
  std::normal_distribution<double> normal_;
  std::uint64_t tick_ = 0;
};

/// Output of a time line for rows that arrive one by one, with these device times.
struct Reported {
  std::uint64_t gaps = 0, rows = 0;
};
Reported reported_of(const std::vector<double>& times_s, double granted_hz) {
  SourceHead head;
  head.recording.channels.push_back({"x", {}, {}});
  head.recording.time.rate_hz = granted_hz;
  head.has_device_clock = true;
  TimeLine line(head);
  std::vector<double> stamps_s;
  std::vector<RecordEvent> events;
  for (const double time_s : times_s) {
    QueueItem item;
    item.arrival.channels = {{0.0}};
    item.arrival.device_ns = {std::llround(time_s * 1e9)};
    item.arrival.host_ns = 77'000'000'000 + std::llround(time_s * 1e9);
    line.stamp(item, stamps_s, events);
  }
  Reported reported;
  for (const RecordEvent& event : events) {
    EXPECT_EQ(event.kind, EventKind::gap) << event.text;
    ++reported.gaps;
    reported.rows += event.rows;
  }
  return reported;
}

std::size_t gaps_by_audit(const std::vector<double>& times_s) {
  Recording recording;
  recording.channels.push_back({"x", {}, std::vector<double>(times_s.size(), 0.0)});
  recording.time.source = TimeSource::stamps;
  recording.time.rate_hz = 1.0 / tick_s;
  for (const double time_s : times_s) recording.time.stamps_s.push_back(time_s - times_s.front());
  return signal::audit(recording).timing.gap_count;
}

TEST(SamplePeriod, CountsTheRowsThatAClockSkipsOftenAsTheAuditDoes) {
  for (const double granted_hz : {0.0, 100.0})
    for (const double skips : {0.002, 0.05, 0.16, 0.25})
      for (const double jitter : {0.0, 0.02}) {
        SkippingClock clock(skips, jitter, 7);
        std::vector<double> times_s;
        // Nothing is reported for the first rows: here they are complete.
        for (int k = -19; k <= 0; ++k) times_s.push_back(tick_s * k);
        const std::size_t rows = times_s.size() + 5000;
        while (times_s.size() < rows) times_s.push_back(clock.next_s());
        const Reported reported = reported_of(times_s, granted_hz);
        EXPECT_EQ(reported.gaps, gaps_by_audit(times_s))
            << granted_hz << ' ' << skips << ' ' << jitter;
        EXPECT_EQ(reported.rows, clock.ticks() + 20 - rows) << granted_hz << ' ' << skips;
      }
}

TEST(SamplePeriod, CountsFrequentSkipsOfAClockThatJittersToo) {
  SkippingClock clock(0.16, 0.05, 8);
  std::vector<double> times_s;
  while (times_s.size() < 5000) times_s.push_back(clock.next_s());
  const Reported reported = reported_of(times_s, 0.0);
  const double gaps = static_cast<double>(gaps_by_audit(times_s));
  EXPECT_NEAR(static_cast<double>(reported.gaps), gaps, 0.01 * gaps);
}

TEST(SamplePeriod, TakesJitterForNoSkip) {
  std::mt19937_64 random(13);
  // Laplace distribution with a mean deviation of a fifteenth.
  std::exponential_distribution<double> size(15.0 / tick_s);
  std::bernoulli_distribution is_late(0.5);
  SamplePeriod step(0.0);
  int holes = 0;
  constexpr int rows = 200'000;
  for (int k = 0; k < rows; ++k) {
    const double step_s = tick_s + (is_late(random) ? 1.0 : -1.0) * size(random);
    holes += step.is_hole(step_s) ? 1 : 0;
    step.add(step_s);
  }
  EXPECT_LT(holes, 1e-4 * rows);
}

TEST(SamplePeriod, LearnsItFromTheVeryRowsThatSkip) {
  SkippingClock clock(0.16, 0.01, 3);
  SamplePeriod step(0.0);
  double before_s = clock.next_s();
  for (int k = 0; k < 16; ++k) {
    const double now_s = clock.next_s();
    step.add(now_s - before_s);
    before_s = now_s;
  }
  EXPECT_NEAR(step.step_s(), tick_s, 0.01 * tick_s);
  EXPECT_TRUE(step.is_hole(2.0 * tick_s));
  EXPECT_FALSE(step.is_hole(1.3 * tick_s));
}

TEST(SamplePeriod, HoldsToTheGrantWhereMostStepsSkipARow) {
  std::mt19937_64 random(11);
  std::bernoulli_distribution skips(0.6);
  SamplePeriod granted(tick_s);
  for (int k = 0; k < 200; ++k) granted.add(skips(random) ? 2.0 * tick_s : tick_s);
  EXPECT_NEAR(granted.step_s(), tick_s, 1e-12);
  EXPECT_TRUE(granted.is_hole(2.0 * tick_s));
}

TEST(SamplePeriod, TakesTheRateThatIsForTheOneThatWasGranted) {
  for (const double factor : {0.4, 0.8, 1.2, 2.0, 7.0}) {
    SamplePeriod step(tick_s);
    for (int k = 0; k < 64; ++k) step.add(factor * tick_s);
    EXPECT_NEAR(step.step_s(), factor * tick_s, 1e-12) << factor;
    EXPECT_FALSE(step.is_hole(1.2 * factor * tick_s));
    EXPECT_TRUE(step.is_hole(2.0 * factor * tick_s));
  }
}

TEST(SamplePeriod, FindsNoHoleInAClockThatTicksAsItLikes) {
  std::mt19937_64 random(12);
  std::exponential_distribution<double> pause(1.0 / tick_s);
  for (const double granted_s : {0.0, tick_s}) {
    SamplePeriod step(granted_s);
    for (int k = 0; k < 20'000; ++k) {
      const double step_s = pause(random);
      ASSERT_FALSE(step.is_hole(step_s)) << k;
      step.add(step_s);
    }
    EXPECT_TRUE(step.is_hole(2.0));
  }
}

TEST(SamplePeriod, FindsNoHolesBetweenBursts) {
  for (const double granted_s : {0.0, tick_s}) {
    SamplePeriod step(granted_s);
    for (int k = 0; k < 2000; ++k) {
      const double step_s = k % 10 == 9 ? 10 * tick_s - 9e-5 : 1e-5;
      ASSERT_FALSE(step.is_hole(step_s)) << k;
      step.add(step_s);
    }
    EXPECT_NEAR(step.step_s(), tick_s, 0.15 * tick_s);
  }
}

TEST(SamplePeriod, IsNotMovedByALongHole) {
  SamplePeriod step(0.0);
  for (int k = 0; k < 40; ++k) step.add(tick_s);
  step.add(1000.0);
  for (int k = 0; k < 100; ++k) {
    EXPECT_NEAR(step.step_s(), tick_s, 1e-12);
    EXPECT_TRUE(step.is_hole(2.0 * tick_s));
    step.add(tick_s);
  }
}

}  // namespace
}  // namespace proofmass::acquire::usual_step_test
