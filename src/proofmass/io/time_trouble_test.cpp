// Faulty clocks: every fault is detected, reported with its position, and corrected or kept.
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/io/test_support.hpp"
#include "proofmass/io/time/running_time.hpp"

namespace proofmass::io::time_trouble_test {
namespace {

/// Stamps first + k·step, as written by an instrument with 2^bits ticks; 0: it never wraps.
std::vector<double> ticks(double first, double step, std::size_t count, int bits = 0) {
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k) {
    const double stamp = first + static_cast<double>(k) * step;
    out.push_back(bits == 0 ? stamp : std::fmod(stamp, std::ldexp(1.0, bits)));
  }
  return out;
}

std::string table(const std::string& name, const std::vector<std::string>& stamps) {
  std::string text = name + ",a\n";
  for (const std::string& stamp : stamps) text += stamp + ",1.5\n";
  return text;
}

std::string table(const std::string& name, const std::vector<double>& stamps) {
  std::vector<std::string> words;
  for (const double stamp : stamps) words.push_back(fmt::format("{:.17g}", stamp));
  return table(name, words);
}

/// Checks that sample k is at k·step for all k.
void expect_even(const Recording& read, double step_s, double tolerance_s = 1e-9) {
  for (std::size_t k = 0; k < read.samples(); ++k)
    ASSERT_NEAR(read.time.at(k), static_cast<double>(k) * step_s, tolerance_s) << k << "\n"
                                                                               << notes_of(read);
}

TEST(Clock, RunsOverAtAnyWidthInAnyUnit) {
  for (const int bits : {16, 24, 31, 32})
    for (const auto& [name, unit_s] : {std::pair{"t_us", 1e-6}, {"t_ms", 1e-3}, {"t_ns", 1e-9}}) {
      const double step = bits == 16 ? 40.0 : 10'000.0;
      const auto read =
          read_text(table(name, ticks(std::ldexp(1.0, bits) - 300.0 * step, step, 800, bits)));
      ASSERT_TRUE(read.has_value());
      EXPECT_TRUE(is_noted(*read, fmt::format("ran over once ({} bits, at line", bits)))
          << notes_of(*read);
      expect_even(*read, step * unit_s);
    }
}

TEST(Clock, RunsOverManyTimes) {
  // 16 bits of microseconds at 500 Hz wrap after 33 samples.
  const auto read = read_text(table("t_us", ticks(1234.0, 2000.0, 5000, 16)));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.002);
  EXPECT_TRUE(is_noted(*read, "ran over 152 times")) << notes_of(*read);
}

TEST(Clock, RunsOverWithASign) {
  std::vector<double> stamps;
  for (int k = 0; k < 400; ++k) stamps.push_back(static_cast<std::int16_t>(32'000 + 10 * k));
  const auto read = read_text(table("t_ms", stamps));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.01);
}

TEST(Clock, RunsOverWhereTicksWereDivided) {
  std::vector<double> seconds;
  std::vector<double> whole_ms;
  for (const double tick : ticks(0x1p32 - 2e6, 10'000.0, 500, 32)) {
    seconds.push_back(tick / 1e6);
    whole_ms.push_back(std::floor(tick / 1e3));
  }
  const auto read = read_text(table("t (s)", seconds));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.01, 1e-6);
  expect_even(read_text(table("t_ms", whole_ms)).value(), 0.01, 1.1e-3);
}

TEST(Clock, RunsOverInAGap) {
  // 30 s of a microsecond counter of 71.6 min are missing around its wrap.
  std::vector<double> stamps = ticks(0x1p32 - 20e6, 10'000.0, 500);
  const auto after = ticks(15e6, 10'000.0, 500);
  stamps.insert(stamps.end(), after.begin(), after.end());
  const auto read = read_text(table("t_us", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->time.at(500) - read->time.at(499), 30.01, 1e-9) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "in a gap of 30.01 s")) << notes_of(*read);
  EXPECT_EQ(read->time.mended_backwards, 0u);
}

TEST(Clock, RunsOverAtMidnightInFigures) {
  std::vector<double> stamps;
  for (int k = 0; k < 400; ++k) stamps.push_back(std::fmod(86'398.0 + 0.01 * k, 86'400.0));
  expect_even(read_text(table("t (s)", stamps)).value(), 0.01);
}

TEST(Clock, GoesOnOneStepLaterWhereItStartsAnew) {
  auto stamps = ticks(812'340.0, 10.0, 300);
  const auto after = ticks(120.0, 10.0, 300);
  stamps.insert(stamps.end(), after.begin(), after.end());
  const auto read = read_text(table("t_ms", stamps));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.01);
  EXPECT_EQ(read->time.mended_backwards, 1u);
  EXPECT_TRUE(is_noted(*read, "fell back once for good (line 302; first from 815330 to 120)"))
      << notes_of(*read);
  for (const Note& note : read->notes)
    if (note.text.find("fell back") != std::string::npos) {
      EXPECT_EQ(note.severity, Severity::bad);
    }
}

TEST(Clock, IsSetFromItsEpochToTheDay) {
  std::vector<double> stamps;
  for (int k = 0; k < 400; ++k) stamps.push_back((k < 150 ? 3.0 : 1.7e9) + 0.01 * k);
  const auto read = read_text(table("t (s)", stamps));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.01, 1e-6);
  EXPECT_TRUE(is_noted(*read, "leapt by more than ten years at line 152")) << notes_of(*read);
}

/// Local time of Berlin near the end of March and of October 2024: seconds of the wall clock.
std::string wall(double seconds_of_day) {
  const auto ms = static_cast<long>(std::llround(seconds_of_day * 1e3));
  return fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3'600'000, ms / 60'000 % 60, ms / 1000 % 60,
                     ms % 1000);
}

TEST(Clock, LosesAndGainsNoHourToSummerTime) {
  for (const double jump_s : {3600.0, -3600.0}) {
    const std::string day = jump_s > 0.0 ? "2024-03-31 " : "2024-10-27 ";
    const double change = jump_s > 0.0 ? 2 * 3600.0 : 3 * 3600.0;
    std::vector<std::string> stamps;
    for (int k = 0; k < 600; ++k) {
      const double t = change - 3.0 + 0.01 * k;
      stamps.push_back(day + wall(t < change - 1e-6 ? t : t + jump_s));
    }
    const auto read = read_text(table("when", stamps));
    ASSERT_TRUE(read.has_value());
    expect_even(*read, 0.01);
    EXPECT_TRUE(is_noted(*read, "at line 302, with no row missing: interpreted as summer time"))
        << notes_of(*read);
    EXPECT_EQ(read->time.mended_backwards, jump_s > 0.0 ? 0u : 1u);
  }
}

TEST(Clock, HonoursTheOffsetsOfItsZone) {
  std::vector<std::string> stamps;
  for (int k = 0; k < 600; ++k) {
    const double t = 3 * 3600.0 - 3.0 + 0.01 * k;
    const bool summer = k < 300;
    stamps.push_back("2024-10-27T" + wall(summer ? t : t - 3600.0) +
                     (summer ? "+02:00" : "+01:00"));
  }
  const auto read = read_text(table("when", stamps));
  ASSERT_TRUE(read.has_value());
  expect_even(*read, 0.01);
  EXPECT_FALSE(is_noted(*read, "summer")) << notes_of(*read);
}

TEST(Clock, KeepsAGapOfAnHourWhereTheZoneIsGiven) {
  std::vector<std::string> stamps;
  for (int k = 0; k < 600; ++k)
    stamps.push_back("2024-10-27T" + wall(3600.0 + 0.01 * k + (k < 300 ? 0.0 : 3600.0)) + "Z");
  const auto read = read_text(table("when", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->time.at(300) - read->time.at(299), 3600.01, 1e-6) << notes_of(*read);
}

TEST(Clock, CountsTheLongRunWhereRowsComeInBursts) {
  // Four samples 2 ms apart, then a pause: 100 Hz in the long run, 500 Hz by the median interval.
  std::vector<double> stamps;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> late(0.0, 2e-3);
  for (int k = 0; k < 4000; ++k) {
    const int burst = k / 4;
    stamps.push_back(0.04 * burst + 2e-3 * (k % 4) + late(random) / 8);
  }
  const auto read = read_text(table("t (s)", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->time.rate_hz, 100.0, 0.5);
  EXPECT_TRUE(is_noted(*read, "bursts")) << notes_of(*read);
}

TEST(Clock, CountsEachStampOfSeveralRows) {
  for (const int rows : {2, 3, 10}) {
    std::vector<double> stamps;
    for (int k = 0; k < 3000; ++k) {
      const int group = k / rows;
      stamps.push_back(10.0 * rows * group);
    }
    const auto read = read_text(table("t_ms", stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(read->time.rate_hz, 100.0, 1.0) << rows << notes_of(*read);
  }
}

TEST(Clock, TellsRowsThatAreLostFromBursts) {
  std::mt19937_64 random(11);
  std::bernoulli_distribution is_lost(0.3);
  std::vector<double> stamps;
  for (int k = 0; k < 8000; ++k)
    if (!is_lost(random)) stamps.push_back(5.0 * k);
  const auto read = read_text(table("t_ms", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->time.rate_hz, 200.0, 1e-6) << notes_of(*read);
  EXPECT_FALSE(is_noted(*read, "bursts"));
}

TEST(Clock, LeavesTheRateWhereSomeRowsAreWrittenTwice) {
  std::vector<double> stamps;
  for (int k = 0; k < 2000; ++k) {
    stamps.push_back(10.0 * k);
    if (k % 20 == 7) stamps.push_back(10.0 * k);
  }
  EXPECT_EQ(read_text(table("t_ms", stamps)).value().time.rate_hz, 100.0);
}

TEST(Clock, IsReadAsDaysOfMatlabAndOfSpreadsheets) {
  for (const double day_of_1970 : {719'529.0, 25'569.0}) {
    std::vector<double> stamps;
    for (int k = 0; k < 200; ++k) stamps.push_back(day_of_1970 + 19'739.5 + k * 0.02 / 86'400.0);
    const auto read = read_text(table("time", stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(read->time.rate_hz, 50.0, 0.1) << notes_of(*read);
    EXPECT_NEAR(static_cast<double>(*read->time.start_ns), 19'739.5 * 86'400e9, 1e4);
    expect_even(*read, 0.02, 1e-5);
  }
}

TEST(Clock, IsReadAsSecondsSince1904) {
  for (const char* name : {"time", "time (s)"}) {
    std::vector<std::string> stamps;
    for (int k = 0; k < 200; ++k)
      stamps.push_back(fmt::format("{}.{:02}", std::int64_t{3'788'324'086}, k % 100));
    for (int k = 100; k < 200; ++k)
      stamps[static_cast<std::size_t>(k)] =
          fmt::format("{}.{:02}", std::int64_t{3'788'324'087}, k % 100);
    const auto read = read_text(table(name, stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->time.start_ns, 1'705'479'286'000'000'000) << notes_of(*read);
    EXPECT_EQ(read->time.rate_hz, 100.0);
  }
}

TEST(Clock, DoesNotMakeADateOfATickCounter) {
  // A 32-bit millisecond counter near its end, which as seconds since 1904 would be 2023.
  const auto read = read_text(table("time", ticks(3'776'000'000.0, 5.0, 100)));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 200.0) << notes_of(*read);
}

TEST(Clock, GoesOnWhereAStretchWithoutStampsIsLong) {
  auto stamps = ticks(0.0, 10.0, 20'000);
  for (std::size_t k = 3000; k < 12'000; ++k) stamps[k] = std::nan("");
  const auto read = read_text(table("t_ms", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.mended, 9000u);
  expect_even(*read, 0.01);
}

/// Stamps with every fault at random positions.
std::vector<double> troubled(std::mt19937_64& random) {
  std::vector<double> out;
  double reading = 0x1p32 - 4e6;
  const auto one_in = [&](int n) {
    return std::uniform_int_distribution<int>(0, n - 1)(random) == 0;
  };
  for (int k = 0; k < 3000; ++k) {
    reading += 10'000.0;
    if (one_in(200)) reading += 1e6;
    if (one_in(150)) reading -= 10'000.0;
    if (one_in(900)) reading = 500.0;
    if (reading >= 0x1p32) reading -= 0x1p32;
    double stamp = reading;
    if (one_in(50)) stamp = std::nan("");
    if (one_in(60)) stamp = 17.0;
    if (one_in(60)) stamp = 3.4e34;
    if (one_in(60)) stamp += 7e8;
    out.push_back(stamp - (0x1p32 - 4e6));
  }
  return out;
}

TEST(RunningTimeBase, GivesTheSameHoweverTheRowsAreCut) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 60; ++trial) {
    TimeEvidence evidence;
    evidence.stamps = StampColumn{"t_us", *parse_unit("us"), {4'290'967'296, 0}, troubled(random)};
    evidence.samples = evidence.stamps->values.size();
    std::vector<double> counter;
    for (std::size_t k = 0; k < evidence.samples; ++k) {
      const std::size_t lost = 2 * (k / 100);
      counter.push_back(static_cast<double>(k + lost));
    }
    evidence.counter = counter;
    evidence.counter_name = "n";
    RunningTimeBase whole(evidence, {});
    RunningTimeBase pieces(evidence, {});
    std::vector<double> expected = evidence.stamps->values;
    ASSERT_EQ(whole.mend(expected, counter, true), expected.size());
    std::vector<double> got;
    std::vector<double> held;
    const std::size_t most = trial % 3 == 0 ? 40 : 900;
    std::size_t next = 0;
    while (got.size() < expected.size()) {
      const std::size_t rows = std::min(
          expected.size() - next, std::uniform_int_distribution<std::size_t>(0, most)(random));
      held.insert(held.end(), evidence.stamps->values.begin() + static_cast<std::ptrdiff_t>(next),
                  evidence.stamps->values.begin() + static_cast<std::ptrdiff_t>(next + rows));
      next += rows;
      const auto count = View<double>(counter).subspan(got.size(), held.size());
      const std::size_t settled = pieces.mend(held, count, next == expected.size());
      ASSERT_LE(held.size() - settled, RunningTimeBase::most_unsettled);
      got.insert(got.end(), held.begin(), held.begin() + static_cast<std::ptrdiff_t>(settled));
      held.erase(held.begin(), held.begin() + static_cast<std::ptrdiff_t>(settled));
    }
    ASSERT_EQ(got, expected) << trial;
    ASSERT_EQ(whole.notes(2).size(), pieces.notes(2).size());
    for (std::size_t i = 0; i < whole.notes().size(); ++i)
      EXPECT_EQ(whole.notes(2)[i].text, pieces.notes(2)[i].text);
    EXPECT_EQ(whole.base().mended, pieces.base().mended);
  }
}

TEST(RunningTimeBase, SettlesTheRowsOfALongStretchWithoutStamps) {
  TimeEvidence evidence;
  evidence.stamps = StampColumn{"t", *parse_unit("s"), {}, ticks(0.0, 0.01, 100)};
  RunningTimeBase running(evidence, {});
  std::vector<double> rows = evidence.stamps->values;
  rows.resize(100 + RunningTimeBase::most_unsettled + 1, std::nan(""));
  const std::size_t settled = running.mend(rows, {}, false);
  EXPECT_GT(settled, 100u);
  EXPECT_LE(rows.size() - settled, RunningTimeBase::most_unsettled);
  EXPECT_NEAR(rows[settled - 1], static_cast<double>(settled - 1) * 0.01, 1e-9);
}

TEST(RunningTimeBase, PlacesRowsByACounterThatRunsOver) {
  TimeEvidence evidence;
  std::vector<double> counter;
  for (int k = 0; k < 1000; ++k)
    if (k % 50 != 30) counter.push_back((k + 200) % 256);
  evidence.counter = counter;
  evidence.counter_name = "packet";
  evidence.samples = counter.size();
  RunningTimeBase running(evidence, {.rate_hz = 50.0});
  ASSERT_TRUE(running.has_stamps());
  EXPECT_EQ(running.base().source, TimeSource::counter);
  std::vector<double> times(counter.size());
  ASSERT_EQ(running.mend(times, counter, true), times.size());
  EXPECT_DOUBLE_EQ(times.back(), 999 / 50.0);
}

}  // namespace
}  // namespace proofmass::io::time_trouble_test
