#include "proofmass/signal/even_grid.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace proofmass::signal::even_grid_test {
namespace {

TimeBase stamped(std::vector<double> stamps_s, double rate_hz) {
  TimeBase time;
  time.source = TimeSource::stamps;
  time.rate_hz = rate_hz;
  time.stamps_s = std::move(stamps_s);
  return time;
}

std::vector<double> ramp(std::size_t n) {
  std::vector<double> values(n);
  for (std::size_t k = 0; k < n; ++k) values[k] = static_cast<double>(k + 1);
  return values;
}

TEST(EvenGrid, OfAUniformTimeBaseIsTheSamplesThemselves) {
  TimeBase time;
  time.rate_hz = 100.0;
  const auto grid = even_grid(time, 5);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->missing, 0U);
  EXPECT_EQ(grid->rate_hz, 100.0);
  EXPECT_EQ(on_even_grid(ramp(5), *grid), ramp(5));
}

TEST(EvenGrid, PutsNaNWhereSamplesAreMissing) {
  std::vector<double> stamps_s;
  stamps_s.reserve(40);
  for (int k = 0; k < 40; ++k) stamps_s.push_back(0.01 * (k < 10 ? k : k + 3));
  const auto grid = even_grid(stamped(stamps_s, 100.0), stamps_s.size());
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->holes.size(), 1U);
  EXPECT_EQ(grid->holes[0].before, 10U);
  EXPECT_EQ(grid->holes[0].missing, 3U);
  const Samples series = on_even_grid(ramp(40), *grid);
  ASSERT_EQ(series.size(), 43U);
  EXPECT_EQ(series[9], 10.0);
  for (std::size_t k = 10; k < 13; ++k) EXPECT_TRUE(std::isnan(series[k]));
  EXPECT_EQ(series[13], 11.0);
  EXPECT_NEAR(grid->rate_hz, 100.0, 1e-9);
}

TEST(EvenGrid, LeavesJitterAlone) {
  std::vector<double> stamps_s;
  stamps_s.reserve(1000);
  for (int k = 0; k < 1000; ++k) stamps_s.push_back(0.01 * (k + 0.2 * std::sin(1.9 * k)));
  const auto grid = even_grid(stamped(stamps_s, 100.0), 1000);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->missing, 0U);
  EXPECT_GT(grid->relative_jitter, 0.1);
}

TEST(EvenGrid, TakesAStampThatWasLateForNoHole) {
  std::vector<double> stamps_s;
  stamps_s.reserve(100);
  for (int k = 0; k < 100; ++k) stamps_s.push_back(0.01 * k);
  // Five samples delayed by 40 ms and delivered together.
  for (std::size_t k = 50; k < 55; ++k) stamps_s[k] = 0.01 * 54 + 1e-4 * static_cast<double>(k);
  const auto grid = even_grid(stamped(stamps_s, 100.0), 100);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->missing, 0U);
}

TEST(EvenGrid, TakesAStallOfTheLoggerForNoHole) {
  // For 0.3 s rows were not stamped; then all of them were, a tenth of a millisecond apart.
  const auto stalled_until = [](std::size_t lost) {
    std::vector<double> stamps_s;
    for (std::size_t k = 0; k < 200; ++k)
      stamps_s.push_back(0.01 * static_cast<double>(k < 130 ? k : k + lost));
    for (std::size_t k = 100; k < 130; ++k)
      stamps_s[k] = stamps_s[130] - 1e-4 * static_cast<double>(130 - k);
    return stamps_s;
  };
  const auto grid = even_grid(stamped(stalled_until(0), 100.0), 200);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->missing, 0U);
  EXPECT_NEAR(grid->rate_hz, 100.0, 1e-9);
  const auto with_loss = even_grid(stamped(stalled_until(12), 100.0), 200);
  ASSERT_TRUE(with_loss);
  EXPECT_EQ(with_loss->missing, 12U);
}

TEST(EvenGrid, FindsTwoHolesCloseToEachOther) {
  std::vector<double> stamps_s;
  stamps_s.reserve(40);
  for (int k = 0; k < 40; ++k)
    stamps_s.push_back(0.01 * (k + (k >= 10 ? 2 : 0) + (k >= 13 ? 5 : 0)));
  const auto grid = even_grid(stamped(stamps_s, 100.0), 40);
  ASSERT_TRUE(grid);
  ASSERT_EQ(grid->holes.size(), 2U);
  EXPECT_EQ(grid->holes[0].missing, 2U);
  EXPECT_EQ(grid->holes[1].missing, 5U);
}

TEST(EvenGrid, TakesTheRateThatTheWholeRecordHas) {
  std::vector<double> stamps_s;
  stamps_s.reserve(5000);
  for (int k = 0; k < 5000; ++k) stamps_s.push_back(k / 99.9);
  const auto grid = even_grid(stamped(stamps_s, 100.0), 5000);
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->rate_hz, 99.9, 1e-6);
}

TEST(EvenGrid, KeepsSamplesWhoseStampsRepeatOrGoBack) {
  std::vector<double> stamps_s{0.0, 0.01, 0.01, 0.03, 0.02, 0.05, 0.06, 0.07, 0.08, 0.09};
  const auto grid = even_grid(stamped(stamps_s, 100.0), stamps_s.size());
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->missing, 0U);
}

TEST(EvenGrid, HasNaNForWhatIsNoMeasurement) {
  TimeBase time;
  time.rate_hz = 1.0;
  const auto grid = even_grid(time, 5);
  ASSERT_TRUE(grid);
  const Samples series = on_even_grid(
      std::vector{3e34, std::numeric_limits<double>::infinity(), 1e-40, 0.0, std::nan("")}, *grid);
  for (const std::size_t k : {0U, 1U, 2U, 4U}) EXPECT_TRUE(std::isnan(series[k])) << k;
  EXPECT_EQ(series[3], 0.0);
}

TEST(EvenGrid, SaysWhyItCannot) {
  EXPECT_EQ(even_grid(TimeBase{}, 5).error().code, Errc::invalid_argument);
  const auto hours = even_grid(stamped({0.0, 0.01, 0.02, 7200.0, 7200.01}, 100.0), 5);
  ASSERT_FALSE(hours);
  EXPECT_EQ(hours.error().code, Errc::corrupt);
}

/// Packets of eight rows at 100 Hz, stamped when the last row is there; 24 rows are lost on the
/// way.
Recording in_packets() {
  Recording recording;
  std::vector<double> stamps_s;
  for (std::size_t k = 0; k < 4000; ++k) {
    const std::size_t number = k < 2000 ? k : k + 24;
    stamps_s.push_back(0.01 * static_cast<double>(number - number % 8));
  }
  recording.time = stamped(stamps_s, 100.0);
  recording.time.band_s = 0.08;
  recording.time.start_ns = 1'000'000'000;
  recording.channels.push_back({"acc_x", *parse_unit("m/s^2"), ramp(4000)});
  return recording;
}

TEST(EvenStamps, AreThoseOfTheSamplesInPackets) {
  const Recording even = with_even_stamps(in_packets());
  for (std::size_t k = 0; k < 4000; ++k)
    EXPECT_NEAR(even.time.stamps_s[k], 0.01 * static_cast<double>(k < 2000 ? k : k + 24), 1e-9)
        << k;
  EXPECT_EQ(even.time.band_s, 0.0);
  EXPECT_NEAR(static_cast<double>(*even.time.start_ns), 1e9 - 35e6, 6e6);  // 3.5 rows later
  EXPECT_EQ(even.notes.size(), 1U);
  EXPECT_EQ(even.channels.front().values.copy(), ramp(4000));
}

TEST(EvenStamps, OfSingleIntervalsAreThemselves) {
  Recording recording = in_packets();
  recording.time.band_s = 0.0;
  const Recording same = with_even_stamps(recording);
  EXPECT_EQ(same.time.stamps_s, recording.time.stamps_s);
  EXPECT_TRUE(same.notes.empty());
}

// The computer was busy for 0.8 s, then stamped the rows of that time at once; another row is late
// by itself, and three are missing.
TEST(LateStamps, AreSpreadOverTheStall) {
  Recording recording;
  std::vector<double> stamps_s, true_s;
  for (int k = 0; k < 2000; ++k) {
    if (k >= 1500 && k < 1503) continue;
    true_s.push_back(0.01 * k);
    const bool is_late = k >= 700 && k < 780;
    stamps_s.push_back(is_late ? 7.79 + 1e-4 * (k - 780) : 0.01 * k + (k == 300 ? 0.004 : 0.0));
  }
  recording.time = stamped(stamps_s, 100.0);
  recording.channels.push_back({"acc_x", *parse_unit("m/s^2"), ramp(stamps_s.size())});
  const Recording mended = without_late_stamps(recording);
  for (std::size_t k = 0; k < true_s.size(); ++k)
    EXPECT_NEAR(mended.time.stamps_s[k], k == 300 ? stamps_s[k] : true_s[k], 1e-3) << k;
  ASSERT_EQ(mended.notes.size(), 1U);
  EXPECT_NE(mended.notes.front().text.find("rows were stamped late, by up to 0.78"),
            std::string::npos)
      << mended.notes.front().text;
}

TEST(LateStamps, AreNotThoseOfGapsAndIrregularRows) {
  Recording recording;
  std::vector<double> stamps_s;
  for (int k = 0; k < 1000; ++k) stamps_s.push_back(0.01 * (k < 400 ? k : k + 90));
  recording.time = stamped(stamps_s, 100.0);
  recording.channels.push_back({"acc_x", *parse_unit("m/s^2"), ramp(1000)});
  EXPECT_EQ(without_late_stamps(recording).time.stamps_s, stamps_s);
  // Edges of a wheel that stops and goes on faster.
  double t = 0.0;
  for (std::size_t k = 0; k < 1000; ++k) {
    stamps_s[k] = t;
    t += k == 300             ? 1.0
         : k > 300 && k < 700 ? 0.004
                              : 0.01 + 0.008 * std::sin(0.05 * static_cast<double>(k));
  }
  recording.time = stamped(stamps_s, 100.0);
  EXPECT_EQ(without_late_stamps(recording).time.stamps_s, stamps_s);
}

}  // namespace
}  // namespace proofmass::signal::even_grid_test
