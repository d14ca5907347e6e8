#include "proofmass/acquire/framing/clock.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::acquire::framing_clock_test {
namespace {

constexpr std::int64_t us = 1'000;

TEST(DeviceClock, RunsOverAtItsWidth) {
  DeviceClock clock(us, 16);
  EXPECT_EQ(clock.place({65'000}), 65'000 * us);
  EXPECT_EQ(clock.place({65'500}), 65'500 * us);
  EXPECT_EQ(clock.place({464}), 66'000 * us);
  EXPECT_EQ(clock.wraps(), 1u);
}

TEST(DeviceClock, OfADeviceThatBeganAnewGoesBack) {
  DeviceClock clock(us, 32);
  EXPECT_EQ(clock.place({3'500'000'000}), 3'500'000'000 * us);
  EXPECT_EQ(clock.place({3'500'001'000}), 3'500'001'000 * us);
  EXPECT_EQ(clock.place({500}), 500 * us);
  EXPECT_EQ(clock.wraps(), 0u);
}

TEST(DeviceClock, RanOverOnlyIfTheWayIsShortBesideItsSteps) {
  DeviceClock clock(us, 16);
  (void)clock.place({64'990});
  (void)clock.place({65'000});
  EXPECT_EQ(clock.place({4'464}), 4'464 * us) << "500 steps over the top are too many";
  DeviceClock text(us, 0);
  (void)text.place({3'007});
  (void)text.place({4'007});
  EXPECT_EQ(text.place({7}), 7 * us) << "nobody divides ticks finer than a microsecond";
}

TEST(DeviceClock, FindsTheWidthOfAClockInText) {
  DeviceClock clock(1'000'000'000, 0);
  EXPECT_EQ(clock.place({4294, 966'000'000}), 4'294'966'000'000);
  EXPECT_EQ(clock.place({4294, 967'000'000}), 4'294'967'000'000);
  EXPECT_EQ(clock.place({0, 704'000}), 4'294'968'000'000) << "micros() / 1e6";
}

TEST(DeviceClock, RefusesReadingsThatNoClockHas) {
  DeviceClock clock(1'000'000'000, 0);
  EXPECT_FALSE(clock.place({std::numeric_limits<std::int64_t>::max()}));
  EXPECT_TRUE(clock.place({1}));
  EXPECT_FALSE(tick_of(std::nan("")));
  EXPECT_FALSE(tick_of(1e300));
  EXPECT_EQ(tick_of(-0.25)->whole, -1);
  EXPECT_EQ(tick_of(-0.25)->nano, 750'000'000);
  EXPECT_EQ(tick_of(0.9999999999)->whole, 1);
}

TEST(RowCounter, KnowsWhatIsMissing) {
  RowCounter counter(8, false);
  EXPECT_EQ(counter.add(250).lost, 0u);
  EXPECT_EQ(counter.add(251).lost, 0u);
  EXPECT_EQ(counter.add(3).lost, 7u);
  EXPECT_EQ(counter.add(std::nan("")).lost, 0u);
  EXPECT_EQ(counter.add(5).lost, 0u) << "the row before had no count, but was there";
}

TEST(RowCounter, TellsABeginningFromALoss) {
  RowCounter counter(16, false);
  (void)counter.add(40'000);
  const CounterStep step = counter.add(0);
  EXPECT_TRUE(step.restarted);
  EXPECT_EQ(step.lost, 0u);
  EXPECT_EQ(counter.add(1).lost, 0u);
}

TEST(RowCounter, KnowsLateRowsOfDatagramsEvenWhereItRunsOver) {
  for (const int bits : {16, 0}) {
    RowCounter counter(bits, true);
    (void)counter.add(65'534);
    EXPECT_EQ(counter.add(0).lost, 1u) << bits;
    EXPECT_TRUE(counter.add(65'535).is_late) << bits;
    EXPECT_EQ(counter.add(1).lost, 0u) << bits;
    EXPECT_TRUE(counter.add(1).is_late) << bits;
  }
}

TEST(RowCounter, DoesNotCallAJumpALoss) {
  RowCounter counter(32, false);
  (void)counter.add(10);
  EXPECT_TRUE(counter.add(3e9).restarted);
}

}  // namespace
}  // namespace proofmass::acquire::framing_clock_test
