#include "proofmass/io/time_base.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/io/test_support.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/even_grid.hpp"

namespace proofmass::io::time_base_test {
namespace {

/// A table with a time column of `stamps` and a column of ones.
std::string table(const std::string& name, const std::vector<std::string>& stamps) {
  std::string text = name + ",a\n";
  for (const std::string& stamp : stamps) text += stamp + ",1.5\n";
  return text;
}

/// Stamps `first` + k·step as integers.
std::vector<std::string> counting(std::int64_t first, std::int64_t step, int count = 20) {
  std::vector<std::string> out;
  for (int k = 0; k < count; ++k) out.push_back(std::to_string(first + k * step));
  return out;
}

TEST(TimeBase, TellsTheUnitOfACounterByItsRate) {
  EXPECT_NEAR(read_text(table("timestamp", counting(2'167'082'953, 8'333))).value().time.rate_hz,
              120.0048, 1e-4);
  EXPECT_EQ(read_text(table("timestamp", counting(17, 10))).value().time.rate_hz, 100.0);
  EXPECT_EQ(read_text(table("timestamp", counting(17, 1))).value().time.rate_hz, 1000.0);
  EXPECT_EQ(read_text(table("timestamp", counting(3, 5'000'000))).value().time.rate_hz, 200.0);
  EXPECT_EQ(read_text(table("t", {"0", "0.005", "0.01", "0.015"})).value().time.rate_hz, 200.0);
}

TEST(TimeBase, TellsAnEpochByItsCentury) {
  const std::int64_t epoch_s = 1'705'479'286;
  for (const std::int64_t per_s :
       {std::int64_t{1'000}, std::int64_t{1'000'000}, std::int64_t{1'000'000'000}}) {
    const auto read = read_text(table("time", counting(epoch_s * per_s, per_s / 50)));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->time.rate_hz, 50.0) << per_s;
    EXPECT_EQ(read->time.start_ns, epoch_s * 1'000'000'000) << per_s;
  }
  // One sample per second with an epoch in seconds is slow, but correct.
  EXPECT_EQ(read_text(table("time", counting(epoch_s, 1))).value().time.rate_hz, 1.0);
}

TEST(TimeBase, BelievesTheHeadersUnit) {
  EXPECT_EQ(read_text(table("time (s)", counting(0, 10))).value().time.rate_hz, 0.1);
  EXPECT_EQ(read_text(table("time_us", counting(0, 10))).value().time.rate_hz, 100'000.0);
}

TEST(TimeBase, KeepsEveryDigitOfAnEpochInNanoseconds) {
  const auto read = read_text(table("t_ns", counting(1'705'479'286'000'000'123, 5'000'001)));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.start_ns, 1'705'479'286'000'000'123);
  EXPECT_EQ(read->time.at(7), 7 * 5'000'001 / 1e9);
}

TEST(TimeBase, SubtractsDecimalsAsDecimals) {
  const auto read = read_text(
      table("t (s)", {"1705479286.105", "1705479286.11", "1705479286.115", "1705479286.12"}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.at(1), 0.005);
  EXPECT_EQ(read->time.at(3), 0.015);
  EXPECT_TRUE(read->time.is_uniform()) << "k / 200 Hz to the last bit";
  EXPECT_EQ(read->time.rate_hz, 200.0);
}

TEST(TimeBase, ReadsCalendarTimes) {
  const auto zoned =
      read_text(table("when", {"2024-01-17T08:14:46.000Z", "2024-01-17T08:14:46.010Z",
                               "2024-01-17T08:14:46.020Z"}));
  ASSERT_TRUE(zoned.has_value()) << zoned.error().message;
  EXPECT_EQ(zoned->time.rate_hz, 100.0);
  EXPECT_EQ(zoned->time.start_ns, 1'705'479'286'000'000'000);
  EXPECT_FALSE(is_noted(*zoned, "taken as UTC"));

  const auto local = read_text(
      "date;clock;a\n17.01.2024;08:14:46,00;1,5\n17.01.2024;08:14:46,01;1\n"
      "17.01.2024;08:14:46,02;2\n");
  ASSERT_TRUE(local.has_value()) << local.error().message;
  EXPECT_EQ(local->time.rate_hz, 100.0);
  EXPECT_EQ(local->time.start_ns, 1'705'479'286'000'000'000);
  EXPECT_TRUE(is_noted(*local, "taken as UTC"));

  const auto blank = read_text(
      "2024-01-17 08:14:46.00 1.5\n2024-01-17 08:14:46.01 2.5\n"
      "2024-01-17 08:14:46.02 2.5\n");
  ASSERT_TRUE(blank.has_value()) << blank.error().message;
  EXPECT_EQ(blank->time.start_ns, 1'705'479'286'000'000'000);
}

TEST(TimeBase, CarriesATimeOfDayAcrossMidnight) {
  const auto read =
      read_text(table("clock", {"23:59:59.98", "23:59:59.99", "00:00:00.00", "00:00:00.01"}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.at(3), 0.03);
}

TEST(TimeBase, UnrollsACounterThatRanOver) {
  auto stamps = counting(4'294'967'296 - 3 * 8'333, 8'333, 3);
  for (const std::string& stamp : counting(0, 8'333, 7)) stamps.push_back(stamp);
  const auto read = read_text(table("SampleTimeFine", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_DOUBLE_EQ(read->time.at(9), 9 * 8'333e-6);
  EXPECT_TRUE(is_noted(*read, "counter ran over once")) << notes_of(*read);
}

TEST(TimeBase, MendsStampsThatAreNoTime) {
  auto stamps = counting(1'000'000, 8'333, 30);
  stamps[5] = "NaN";
  stamps[9] = "3.4028e34";
  stamps[14] = "17";
  stamps[20] = "99999999";
  const auto read = read_text(table("t_us", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.mended, 4u) << notes_of(*read);
  EXPECT_EQ(read->time.mended_backwards, 1u);
  for (std::size_t k = 0; k < 30; ++k)
    EXPECT_NEAR(read->time.at(k), static_cast<double>(k) * 8'333e-6, 1e-12) << k;
  EXPECT_TRUE(is_noted(*read, "lines 7, 11, 16, 22")) << notes_of(*read);
}

TEST(TimeBase, MendsAFirstStampThatIsNoTime) {
  for (const char* first : {"nan", "3e34", "0", "99999999999"}) {
    auto stamps = counting(1'000'000'000, 8'333, 30);
    stamps[0] = first;
    const auto read = read_text(table("t_us", stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->time.mended, 1u) << first;
    EXPECT_NEAR(static_cast<double>(*read->time.start_ns), 1e12, 2.0) << first;
    EXPECT_NEAR(read->time.at(29), 29 * 8'333e-6, 1e-9) << first;
  }
}

TEST(TimeBase, PutsAMendedStampWhereTheCounterSays) {
  // Packets 4 and 5 are lost: packet 6 is three steps after packet 3, its stamp unreadable.
  const auto read = read_text(
      "PacketCounter,t_ms,a\n0,0,1\n1,10,1\n2,20,1\n3,30,1\n6,inf,1\n7,70,1\n8,80,1\n9,90,1\n"
      "10,100,1\n11,110,1\n12,120,1\n13,130,1\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_DOUBLE_EQ(read->time.at(4), 0.060);
  EXPECT_TRUE(is_noted(*read, "set from PacketCounter")) << notes_of(*read);
}

TEST(TimeBase, KeepsGapsAndRepeatsAndGoesOnWhereTheClockWasSetBack) {
  const auto read = read_text(table("t (s)", {"0", "1", "2", "9", "10", "10", "11", "4", "5", "6",
                                              "7", "8", "9", "10", "11", "12", "13", "14", "15"}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.mended, 0u);
  EXPECT_EQ(read->time.mended_backwards, 1u);
  EXPECT_EQ(read->time.at(3), 9.0);
  EXPECT_EQ(read->time.at(5), 10.0);
  EXPECT_EQ(read->time.at(7), 12.0);
  EXPECT_EQ(read->time.at(18), 23.0);
  EXPECT_TRUE(is_noted(*read, "fell back once for good (line 9; first from 11 to 4)"));
}

TEST(TimeBase, TakesTheGivenRateBeforeTheStamps) {
  const auto read = read_text(table("t", counting(0, 10)), {.rate_hz = 250.0});
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.source, TimeSource::given_rate);
  EXPECT_EQ(read->time.at(5), 0.02);
  EXPECT_FALSE(read_text(table("t", counting(0, 10)), {.rate_hz = -1.0}).has_value());
}

TEST(TimeBase, PlacesSamplesByACounterOfKnownRate) {
  std::string text = "packet,a\n";
  for (int k = 0; k < 40; ++k)
    if (k != 17 && k != 18) text += std::to_string(k) + ",1.5\n";
  const auto read = read_text(text, {.rate_hz = 100.0});
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.source, TimeSource::counter);
  EXPECT_EQ(read->time.at(16), 0.16);
  EXPECT_EQ(read->time.at(17), 0.19);
}

TEST(TimeBase, DoesNotTakePacketNumbersForTime) {
  const auto read = read_text("Packet number,ax (g)\n3,0.1\n5,0.1\n6,0.2\n8,0.1\n");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.source, TimeSource::none);
  EXPECT_EQ(read->time.rate_hz, 0.0);
  EXPECT_TRUE(recommends(*read, "rate"));
}

TEST(TimeBase, GivesAColumnBackThatDoesNotAscend) {
  const auto read = read_text(table("time", {"5", "3", "4", "1", "2", "0.5"}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.source, TimeSource::none);
  ASSERT_NE(read->find("time"), nullptr);
  EXPECT_EQ(read->find("time")->values, (std::vector<double>{5, 3, 4, 1, 2, 0.5}));
}

TEST(TimeBase, ObeysTheNameOfATimeColumn) {
  const std::string text = "time,device_time,a\n0,100,1\n0,110,2\n0,120,3\n";
  const auto read = read_text(text, {.time_channel = "Device_Time"});
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.channel, "device_time");
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_EQ(read_text(text, {.time_channel = "clock"}).error().code, Errc::invalid_argument);
}

TEST(TimeBase, SeesThroughStampsRoundedToMilliseconds) {
  std::vector<std::string> stamps;
  for (int k = 0; k < 600; ++k) stamps.push_back(std::to_string(std::lround(k * 1000.0 / 60.0)));
  EXPECT_NEAR(read_text(table("t_ms", stamps)).value().time.rate_hz, 60.0, 0.01);
}

TEST(TimeBase, CountsSamplesOverTheDurationWhereStampsComeInBursts) {
  std::vector<std::string> stamps;
  for (int k = 0; k < 400; ++k) stamps.push_back(std::to_string(k / 8 * 40));
  const auto read = read_text(table("t_ms", stamps));
  EXPECT_NEAR(read->time.rate_hz, 200.0, 5.0);
  EXPECT_TRUE(is_noted(*read, "bursts"));
}

TEST(TimeBase, NoticesARateInThePreambleThatTheStampsBelie) {
  const auto read =
      read_text("# sample rate: 100 Hz\n" + table("t (s)", {"0", "0.1", "0.2", "0.3"}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 10.0);
  EXPECT_TRUE(is_noted(*read, "one of them is wrong")) << notes_of(*read);
}

/// Rounded to whole milliseconds, at this rate; some samples are lost at random.
std::vector<std::string> in_whole_ms(double rate_hz, int samples, double lost, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  const double phase_ms = uniform(random);
  std::vector<std::string> out;
  for (int k = 0; k < samples; ++k)
    if (uniform(random) >= lost)
      out.push_back(fmt::format("{:.0f}", std::floor(1e3 * k / rate_hz + phase_ms)));
  return out;
}

TEST(TimeBase, FindsTheRateBehindStampsOfWholeTicks) {
  for (const double rate_hz : {667.0, 680.0, 700.0, 833.0, 952.0, 980.0, 1125.0, 1600.0}) {
    const auto read = read_text(table("t_ms", in_whole_ms(rate_hz, 8000, 0.0, 1)));
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(read->time.rate_hz, rate_hz, 5e-5 * rate_hz);
    const auto audit = signal::audit(*read);
    EXPECT_EQ(audit.timing.gap_count, 0U) << rate_hz;
  }
}

/// The samples of 8000 that are left have these stamps in milliseconds.
void expect_rate_and_loss(const std::vector<std::string>& stamps, double rate_hz) {
  const auto read = read_text(table("t_ms", stamps));
  ASSERT_TRUE(read.has_value());
  EXPECT_NEAR(read->time.rate_hz, rate_hz, 1e-4 * rate_hz);
  const auto grid = signal::even_grid(read->time, read->samples());
  ASSERT_TRUE(grid.has_value());
  EXPECT_EQ(grid->missing + stamps.size(), 8000U) << rate_hz;
}

TEST(TimeBase, FindsWhatIsLostBesideWholeTicks) {
  for (const double rate_hz : {680.0, 700.0, 833.0, 952.0})
    expect_rate_and_loss(in_whole_ms(rate_hz, 8000, 0.002, 2), rate_hz);
}

// As by a logger that is busy: single rows close to each other, and up to 30 at once.
TEST(TimeBase, FindsBlocksOfLostRowsBesideWholeTicks) {
  const auto is_lost = [](int k) {
    const int block = k / 1501, at = k % 1501;
    return at == 20 || at == 23 || (at >= 700 && at < 702 + 7 * block);
  };
  for (const double rate_hz : {681.3, 799.1, 833.7, 912.9}) {
    std::vector<std::string> stamps;
    for (int k = 0; k < 8000; ++k)
      if (!is_lost(k)) stamps.push_back(fmt::format("{:.0f}", std::floor(1e3 * k / rate_hz)));
    expect_rate_and_loss(stamps, rate_hz);
  }
}

// The stamps are those of 800 Hz exactly.
TEST(TimeBase, ClaimsNoMoreThanARepeatingPatternOfStampsShows) {
  constexpr double rate_hz = 800.003;
  const auto read = read_text(table("t_ms", in_whole_ms(rate_hz, 8000, 0.0, 3)));
  ASSERT_TRUE(read.has_value());
  const double std_hz = signal::audit(*read).timing.rate_std_hz.value();
  EXPECT_LT(std::abs(read->time.rate_hz - rate_hz), 2.0 * std_hz);
  EXPECT_LT(std_hz, 0.02);
}

TEST(TimeBase, TakesNoLossForRounding) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto read = read_text(table("t_ms", in_whole_ms(1000.0, 4000, 0.05, seed)));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->time.rate_hz, 1000.0) << seed;
  }
}

TEST(TimeBase, DoesNotLetLostRowsMoveTheRateOfStampsThatJitter) {
  for (const auto& [jitter_std, lost] : {std::pair{0.08, 0.2}, {0.12, 0.06}}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<double> uniform;
      std::normal_distribution<double> jitter(0.0, jitter_std);
      std::vector<std::string> stamps;
      for (int k = 0; k < 6000; ++k)
        if (const double at = k + jitter(random); uniform(random) >= lost)
          stamps.push_back(fmt::format("{:.6f}", 1.0 + at / 100.0));
      const auto read = read_text(table("t_s", stamps));
      ASSERT_TRUE(read.has_value());
      EXPECT_NEAR(read->time.rate_hz, 100.0, 0.1) << seed;
      EXPECT_NEAR(signal::audit(*read).timing.long_run_hz.value(), 100.0, 0.1) << seed;
    }
  }
}

// Steps of 4 to 15 ms: neither their median nor the mean of those next to it is the period.
TEST(TimeBase, FindsTheRateOfStampsInWholeMillisecondsThatJitter) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> jitter(0.0, 0.12);
    std::vector<std::string> stamps;
    for (int k = 0; k < 3000; ++k)
      stamps.push_back(fmt::format("{:.3f}", 1.0 + (k + jitter(random)) / 104.3));
    const auto read = read_text(table("t_s", stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(read->time.rate_hz, 104.3, 0.05) << seed;
    EXPECT_EQ(signal::audit(*read).timing.gap_count, 0U) << seed;
  }
}

TEST(TimeBase, FindsNoGapsBetweenBursts) {
  for (const int rows : {4, 7, 16}) {
    std::vector<std::string> stamps;
    for (int k = 0; k < 8000; ++k) {
      const int burst = k / rows;
      stamps.push_back(fmt::format("{:.6f}", (burst + 1) * rows / 200.0));
    }
    const auto read = read_text(table("t_s", stamps));
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(read->time.rate_hz, 200.0, 0.01);
    const auto audit = signal::audit(*read);
    EXPECT_EQ(audit.timing.gap_count, 0U) << rows;
    const auto grid = signal::even_grid(read->time, read->samples());
    ASSERT_TRUE(grid.has_value());
    EXPECT_EQ(grid->missing, 0U) << rows;
  }
}

}  // namespace
}  // namespace proofmass::io::time_base_test
