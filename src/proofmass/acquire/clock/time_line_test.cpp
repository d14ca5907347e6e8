#include "proofmass/acquire/clock/time_line.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/acquire/clock/clock_fit.hpp"
#include "proofmass/acquire/clock/gap_detector.hpp"
#include "proofmass/acquire/recorder/latency_histogram.hpp"

namespace proofmass::acquire::time_line_test {
namespace {

constexpr std::int64_t ms = 1'000'000;

SourceHead head_of(bool has_device_clock, double rate_hz, bool is_paced = true) {
  SourceHead head;
  head.recording.channels.push_back({"x", {}, {}});
  head.recording.time.rate_hz = rate_hz;
  head.has_device_clock = has_device_clock;
  head.is_paced = is_paced;
  return head;
}

/// Rows that arrive at `host_ms`, with these device times if any.
QueueItem rows_at(std::int64_t host_ms,
                  std::size_t rows,
                  const std::vector<std::int64_t>& device_ms = {},
                  std::uint64_t lost = 0) {
  QueueItem item;
  item.arrival.channels = {std::vector<double>(rows, 0.0)};
  for (const std::int64_t at : device_ms) item.arrival.device_ns.push_back(at * ms);
  item.arrival.lost_before = lost;
  item.arrival.host_ns = 77'000'000'000 + host_ms * ms;
  return item;
}

/// A time line that stores all its output.
class Folded {
 public:
  explicit Folded(const SourceHead& head) : line_(head) {}
  void add(const QueueItem& item) {
    std::vector<double> stamps_s;
    line_.stamp(item, stamps_s, events);
    stamps.insert(stamps.end(), stamps_s.begin(), stamps_s.end());
  }
  /// Ten rows, a tenth of a second, `count` times.
  void add_device(std::int64_t host_ms, std::int64_t device_ms, int count) {
    for (int i = 0; i < count; ++i) {
      std::vector<std::int64_t> times;
      for (int k = 0; k < 10; ++k) times.push_back(device_ms + 100 * i + 10 * k);
      add(rows_at(host_ms + 100 * i + 90, 10, times));
    }
  }
  [[nodiscard]] bool never_goes_back() const { return std::ranges::is_sorted(stamps); }
  [[nodiscard]] std::size_t count(EventKind kind) const {
    return static_cast<std::size_t>(
        std::ranges::count(events, kind, [](const RecordEvent& event) { return event.kind; }));
  }

  std::vector<double> stamps;
  std::vector<RecordEvent> events;

  [[nodiscard]] TimeLine& line() { return line_; }

 private:
  TimeLine line_;
};

TEST(TimeLine, FollowsTheDevicesClockFromItsFirstRow) {
  Folded line(head_of(true, 100.0));
  line.add_device(0, 500'000, 50);
  for (std::size_t k = 0; k < 500; ++k) ASSERT_NEAR(line.stamps[k], 0.01 * double(k), 1e-12);
  EXPECT_TRUE(line.events.empty());
}

TEST(TimeLine, TellsAHoleInTheDevicesTimeAndCountsItsRows) {
  Folded line(head_of(true, 100.0));
  line.add_device(0, 0, 10);
  line.add_device(1500, 1500, 10);
  ASSERT_EQ(line.count(EventKind::gap), 1u);
  EXPECT_EQ(line.events[0].rows, 50u);
  EXPECT_NEAR(line.events[0].time_s, 0.99, 1e-9);
  EXPECT_NEAR(line.events[0].duration_s, 0.51, 1e-9);
  EXPECT_NEAR(line.stamps[100], 1.5, 1e-9);
  EXPECT_EQ(line.line().rows(), 250u);
}

TEST(TimeLine, TakesKnownLossesForNoGap) {
  Folded line(head_of(true, 100.0));
  line.add_device(0, 0, 10);
  line.add(rows_at(1100, 1, {1100}, 10));
  EXPECT_EQ(line.count(EventKind::lost), 1u);
  EXPECT_EQ(line.count(EventKind::gap), 0u);
  EXPECT_EQ(line.line().rows(), 111u);
}

TEST(TimeLine, BridgesADevicesClockThatStepsBackOrAhead) {
  for (const std::int64_t jump_ms : {-3'600'000, -5'000, 5'000, 1'600'000'000}) {
    Folded line(head_of(true, 100.0));
    line.add_device(0, 10'000'000, 30);
    line.add_device(3000, 10'003'000 + jump_ms, 30);
    EXPECT_EQ(line.count(EventKind::clock_jump), 1u) << jump_ms;
    EXPECT_EQ(line.count(EventKind::gap), 0u) << jump_ms;
    EXPECT_TRUE(line.never_goes_back());
    EXPECT_NEAR(line.stamps.back(), 5.99, 0.05) << jump_ms;
  }
}

TEST(TimeLine, SurvivesAnyTimeOfADevice) {
  constexpr auto most = std::numeric_limits<std::int64_t>::max();
  constexpr auto least = std::numeric_limits<std::int64_t>::min();
  for (const bool is_paced : {true, false}) {
    Folded line(head_of(true, 0.0, is_paced));
    std::int64_t host_ms = 0;
    for (const std::int64_t odd : {most, least, std::int64_t{0}, most, least, std::int64_t{-1}}) {
      QueueItem item = rows_at(host_ms += 100, 3);
      item.arrival.device_ns = {odd, odd, odd / 2};
      line.add(item);
    }
    EXPECT_TRUE(line.never_goes_back());
    for (const double stamp : line.stamps) EXPECT_TRUE(std::isfinite(stamp));
  }
}

TEST(TimeLine, CountsWhereTheDevicesClockIsDead) {
  for (const std::size_t rows : {1, 10, 100}) {
    Folded line(head_of(true, 100.0));
    const std::vector<std::int64_t> zeros(rows, 0);
    for (std::size_t k = rows; k <= 1000; k += rows)
      line.add(rows_at(10 * static_cast<std::int64_t>(k), rows, zeros));
    EXPECT_EQ(line.count(EventKind::clock_dead), 1u);
    EXPECT_EQ(line.count(EventKind::gap), 0u);
    EXPECT_TRUE(line.never_goes_back());
    EXPECT_NEAR(line.stamps.back(), 9.99, 0.17) << rows;
  }
}

TEST(TimeLine, CountsByTheGrantedRateAndOverWhatIsLost) {
  Folded line(head_of(false, 100.0));
  line.add(rows_at(100, 10));
  line.add(rows_at(250, 10, {}, 5));
  EXPECT_NEAR(line.stamps[9], 0.09, 1e-12);
  EXPECT_NEAR(line.stamps[10], 0.15, 1e-12);
  EXPECT_EQ(line.events.at(0).kind, EventKind::lost);
  EXPECT_EQ(line.events.at(0).rows, 5u);
}

/// Passes items through a hold and adds its output in order.
void fold_through(GapDetector& hold, Folded& line, QueueItem item) {
  hold.put(std::move(item));
  QueueItem settled;
  while (hold.take(settled, false)) line.add(settled);
}

TEST(GapDetector, TellsADelayFromAGap) {
  for (const bool is_gap : {true, false}) {
    Folded line(head_of(false, 100.0));
    GapDetector hold(false, true, 100.0, 2.0);
    for (int i = 1; i <= 20; ++i) fold_through(hold, line, rows_at(100 * i, 10));
    // Five seconds of silence; then the delayed rows arrive at once, or they do not.
    const int burst = is_gap ? 0 : 49;
    for (int i = 0; i < burst; ++i) fold_through(hold, line, rows_at(7000 + i, 10));
    for (int i = 1; i <= 20; ++i) fold_through(hold, line, rows_at(7000 + 100 * i, 10));
    EXPECT_EQ(line.count(EventKind::gap), is_gap ? 1u : 0u);
    EXPECT_TRUE(line.never_goes_back());
    EXPECT_NEAR(line.stamps.back(), is_gap ? 8.9 : 8.89, 0.15);
  }
}

TEST(GapDetector, LetsNothingWaitAtTheEnd) {
  GapDetector hold(false, true, 0.0, 2.0);
  hold.put(rows_at(100, 10));
  QueueItem item;
  EXPECT_FALSE(hold.take(item, false));
  EXPECT_TRUE(hold.take(item, true));
  EXPECT_EQ(item.arrival.rows(), 10u);
}

TEST(TimeLine, TakesTheHostsTimeAndItsJitterAwayWhereThereIsNoClock) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> jitter_ms(0.0, 30.0);
  Folded line(head_of(false, 0.0));
  GapDetector hold(false, true, 0.0, 2.0);
  for (int i = 1; i <= 600; ++i)
    fold_through(hold, line, rows_at(100 * i + static_cast<int>(jitter_ms(random)), 10));
  ASSERT_EQ(line.stamps.size(), 6000u);
  EXPECT_TRUE(line.never_goes_back());
  double worst = 0.0;
  for (std::size_t k = 1001; k < 6000; ++k)
    worst = std::max(worst, std::abs(line.stamps[k] - line.stamps[k - 1] - 0.01));
  EXPECT_LT(worst, 0.001);
  EXPECT_EQ(line.count(EventKind::gap), 0u);
}

TEST(TimeLine, LeavesTimesAloneThatComeAsTheyLike) {
  std::mt19937_64 random(6);
  std::exponential_distribution<double> pause(1.0);
  Folded line(head_of(false, 0.0));
  std::vector<double> truth;
  double now_s = 0.0;
  for (int i = 0; i < 2000; ++i) {
    now_s += 0.1 * pause(random);
    truth.push_back(now_s);
    line.add(rows_at(static_cast<std::int64_t>(std::llround(1000 * now_s)), 1));
  }
  double squares = 0.0;
  for (std::size_t k = 200; k < truth.size(); ++k) {
    const double wrong = line.stamps[k] - line.stamps[200] - (truth[k] - truth[200]);
    squares += wrong * wrong / double(truth.size());
  }
  EXPECT_LT(std::sqrt(squares), 0.02);
}

TEST(TimeLine, MarksTheGapOfAReconnection) {
  Folded line(head_of(true, 100.0));
  line.add_device(0, 7000, 10);
  line.line().reopen(head_of(true, 100.0));
  line.add_device(4000, 0, 10);
  ASSERT_EQ(line.count(EventKind::gap), 1u);
  EXPECT_NEAR(line.stamps[100], 4.0, 0.05);
  EXPECT_NEAR(static_cast<double>(line.events[0].rows), 300.0, 5.0);
}

/// Delays of a bursty connection: rarely zero, sometimes long.
class Delays {
 public:
  explicit Delays(std::uint64_t seed) : random_(seed) {}
  double next() {
    if (unit_(random_) < 0.02) burst_s_ = 0.2 * unit_(random_);
    burst_s_ = std::max(0.0, burst_s_ - 0.01);
    return burst_s_ + 0.002 * exponential_(random_);
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_;
  std::exponential_distribution<double> exponential_{1.0};
  double burst_s_ = 0.0;
};

TEST(ClockFit, FindsTheDriftAndKeepsItsWordAboutIt) {
  constexpr int trials = 1000;
  constexpr double drift = 43e-6;
  for (const double duration_s : {60.0, 600.0}) {
    int inside = 0;
    for (int trial = 0; trial < trials; ++trial) {
      Delays delays(static_cast<std::uint64_t>(trial + 1));
      ClockFit fit;
      for (double t = 0.0; t < duration_s; t += 0.05) fit.add(t, (1.0 + drift) * t + delays.next());
      const auto found = fit.rate_error();
      ASSERT_TRUE(found);
      inside += std::abs(found->value - drift) < 1.96 * found->std ? 1 : 0;
    }
    const double coverage = inside / double(trials);
    EXPECT_GE(coverage, 0.93) << duration_s;
    EXPECT_LE(coverage, 0.97) << duration_s;
  }
}

TEST(ClockFit, SaysNothingTooEarly) {
  ClockFit fit;
  for (double t = 0.0; t < 29.0; t += 0.1) fit.add(t, t);
  EXPECT_FALSE(fit.rate_error());
}

TEST(ClockFit, StaysSmallAndTrueOverDays) {
  ClockFit fit;
  Delays delays(3);
  for (double t = 0.0; t < 3 * 86'400.0; t += 0.5) fit.add(t, (1.0 - 20e-6) * t + delays.next());
  const auto found = fit.rate_error();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->value, -20e-6, 1e-8);
  EXPECT_LT(found->std, 1e-8);
}

TEST(LatencyHistogram, FindsQuantiles) {
  LatencyHistogram histogram;
  EXPECT_FALSE(histogram.latency());
  for (int i = 1; i <= 1000; ++i) histogram.add(1e-3 * i);
  const Latency latency = *histogram.latency();
  EXPECT_EQ(latency.blocks, 1000u);
  EXPECT_NEAR(latency.median_s, 0.5, 0.04);
  EXPECT_NEAR(latency.p99_s, 0.99, 0.07);
  EXPECT_EQ(latency.worst_s, 1.0);
}

}  // namespace
}  // namespace proofmass::acquire::time_line_test
