#include "proofmass/report/page/ticks.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::report::ticks_test {
namespace {

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> all;
  all.reserve(ticks.size());
  for (const Tick& tick : ticks) all.push_back(tick.label);
  return all;
}

TEST(LinearTicks, StandOneTwoOrFiveTimesAPowerOfTenApart) {
  EXPECT_EQ(labels(linear_ticks(0.0, 1.0, 5)),
            (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(linear_ticks(-3.0, 7.0, 4)), (std::vector<std::string>{"0", "5"}));
}

TEST(LinearTicks, AreNeverMoreThanAskedForAndLieInside) {
  for (int most = 2; most < 12; ++most) {
    for (double range = 1e-7; range < 1e9; range *= 1.7) {
      const double low = -0.37 * range, high = low + range;
      const auto ticks = linear_ticks(low, high, most);
      EXPECT_LE(ticks.size(), static_cast<std::size_t>(most) + 1);
      EXPECT_GE(ticks.size(), 1U);
      for (const Tick& tick : ticks) {
        EXPECT_GE(tick.value, low - 1e-6 * range);
        EXPECT_LE(tick.value, high + 1e-6 * range);
      }
    }
  }
}

TEST(LinearTicks, DistinguishNeighbours) {
  const auto ticks = linear_ticks(79.6141, 79.6149, 6);
  ASSERT_GE(ticks.size(), 3U);
  EXPECT_NE(ticks[0].label, ticks[1].label);
}

TEST(LinearTicks, TakeThePowerOfTenOutOfVeryLargeNumbers) {
  EXPECT_EQ(labels(linear_ticks(0.0, 3e8, 3)),
            (std::vector<std::string>{"0", "1·10⁸", "2·10⁸", "3·10⁸"}));
}

TEST(LinearTicks, OfARangeThatIsNoneAreNone) {
  EXPECT_TRUE(linear_ticks(1.0, 1.0, 5).empty());
  EXPECT_TRUE(linear_ticks(2.0, 1.0, 5).empty());
  EXPECT_TRUE(linear_ticks(0.0, std::nan(""), 5).empty());
  EXPECT_TRUE(linear_ticks(0.0, std::numeric_limits<double>::infinity(), 5).empty());
  EXPECT_TRUE(linear_ticks(1e20, std::nextafter(1e20, 2e20), 5).empty());
}

TEST(LogTicks, AreTheDecadesInside) {
  EXPECT_EQ(labels(log_ticks(0.5, 2000.0, 8)),
            (std::vector<std::string>{"1", "10", "100", "1000"}));
  EXPECT_EQ(labels(log_ticks(1e-7, 1e-3, 8)),
            (std::vector<std::string>{"10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"}));
}

TEST(LogTicks, HaveTwosAndFivesWhereThereIsRoom) {
  EXPECT_EQ(labels(log_ticks(0.4, 30.0, 8)),
            (std::vector<std::string>{"0.5", "1", "2", "5", "10", "20"}));
  EXPECT_EQ(labels(log_ticks(300.0, 6000.0, 6)),
            (std::vector<std::string>{"500", "1000", "2000", "5000"}));
}

TEST(LogTicks, SkipDecadesWhereThereAreMany) {
  const auto ticks = log_ticks(1e-12, 1e12, 6);
  EXPECT_LE(ticks.size(), 7U);
  EXPECT_GE(ticks.size(), 4U);
}

TEST(LogTicks, AreLinearWithinADecade) {
  EXPECT_EQ(labels(log_ticks(320.0, 480.0, 4)), (std::vector<std::string>{"350", "400", "450"}));
  EXPECT_TRUE(log_ticks(0.0, 9.0, 6).empty());
}

}  // namespace
}  // namespace proofmass::report::ticks_test
