#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"
#include "proofmass/io/ximu/packets.hpp"
#include "proofmass/io/ximu/rates.hpp"
#include "proofmass/io/ximu/specimens.hpp"

namespace proofmass::io::ximu::ximu_test {
namespace {

using specimen::ximu_date_time;
using specimen::ximu_inertial;
using specimen::ximu_packet;

/// Seconds of the given number of inertial packets, each preceded by a date and time.
std::string session(int seconds, int a_second) {
  std::string bytes;
  for (int s = 0; s < seconds; ++s) {
    bytes += ximu_date_time(s);
    for (int k = 0; k < a_second; ++k)
      bytes += ximu_inertial({16, -32, 0, 2048, -1024, 1, 512, 0, static_cast<std::int16_t>(k)});
  }
  return bytes;
}

TEST(Decoder, TakesTheMakersPacketApart) {
  // The first packet of a published file: 2000-01-01 10:20:54.
  Decoder decoder;
  const std::string sent("\x02\x40\x00\x10\x08\x40\x40\x54\x45\xC0", 10);
  for (const char c : sent) {
    const bool is_last = c == '\xC0';
    EXPECT_EQ(decoder.take(static_cast<std::uint8_t>(c)),
              is_last ? Decoder::Outcome::packet : Decoder::Outcome::more);
  }
  EXPECT_EQ(decoder.packet().header, date_time_kind);
  EXPECT_EQ(decoder.packet().date_time_s(), 946'722'054);
}

TEST(Ximu, FiguresAreInTheirUnits) {
  const auto read = read_text(session(15, 64));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "x-IMU");
  EXPECT_EQ(read->samples(), 15u * 64u);
  const auto first = [&](const char* name) { return read->find(name)->values.front(); };
  EXPECT_EQ(first("Gyroscope X"), 1.0);
  EXPECT_EQ(first("Gyroscope Y"), -2.0);
  EXPECT_EQ(first("Accelerometer X"), 1.0);
  EXPECT_EQ(first("Accelerometer Y"), -0.5);
  EXPECT_EQ(first("Accelerometer Z"), 1.0 / 2048.0);
  EXPECT_EQ(first("Magnetometer X"), 0.25);
  EXPECT_EQ(read->find("Accelerometer X")->unit.symbol, "g");
}

TEST(Ximu, RateIsCountedBetweenDates) {
  const auto read = read_text(session(15, 64));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 64.0);
  EXPECT_EQ(read->time.start_ns, 946'722'000'000'000'000);
  EXPECT_TRUE(is_noted(*read, "896 packets in the 14 s")) << notes_of(*read);
}

TEST(Ximu, WithoutDatesAsksForTheRate) {
  std::string bytes;
  for (int k = 0; k < 50; ++k) bytes += ximu_inertial({0, 0, 0, 0, 0, 2048, 0, 0, 0});
  const auto read = read_text(bytes);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 0.0);
  EXPECT_TRUE(recommends(*read, "rate")) << notes_of(*read);
}

TEST(Ximu, EachKindIsATable) {
  std::string bytes = session(15, 64);
  for (int k = 0; k < 30; ++k) bytes += ximu_packet(7, {0x40, 0x00, 0x19, 0x80});
  ReadOptions options;
  options.variables = {"CalBattAndTherm"};
  const auto read = read_text(bytes, options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 30u);
  EXPECT_EQ(read->find("Battery voltage")->values.front(), 4.0);
  EXPECT_EQ(read->find("Thermometer")->values.front(), 25.5);
  EXPECT_EQ(read->find("Thermometer")->unit.quantity, Quantity::temperature);
}

TEST(Ximu, DamagedPacketsAreLeftOutAndTold) {
  std::string bytes = session(2, 8);
  const std::size_t byte = bytes.size();
  bytes += ximu_packet(9, std::vector<std::uint8_t>(18, 0), 1);
  bytes += ximu_packet(9, {1, 2, 3, 4});
  bytes += session(2, 8);
  const auto read = read_text(bytes);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->samples(), 32u);
  EXPECT_TRUE(is_noted(
      *read, "2 of 38 packets are damaged, the first ends at byte " + std::to_string(byte + 23)))
      << notes_of(*read);
}

TEST(Ximu, BrokenOffAnywhereKeepsWholePackets) {
  const std::string bytes = session(2, 4);
  const std::size_t inertial = ximu_inertial({0, 0, 0, 0, 0, 0, 0, 0, 0}).size();
  const std::size_t dated = ximu_date_time(0).size();
  std::size_t readable = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = read_text(bytes.substr(0, size));
    if (!read) {
      ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
      continue;
    }
    ++readable;
    const std::size_t first_second = dated + 4 * inertial;
    const std::size_t whole =
        size < first_second
            ? (size - dated) / inertial
            : 4 + (size < first_second + dated ? 0 : (size - first_second - dated) / inertial);
    ASSERT_EQ(read->samples(), whole) << size;
  }
  EXPECT_GT(readable, bytes.size() / 2);
}

TEST(XimuRate, IsAPowerOfTwoThatFits) {
  EXPECT_EQ(rate_hz_of(9), 256.0);
  EXPECT_EQ(rate_hz_of(0), std::nullopt);
  EXPECT_EQ(rate_hz_of(11), std::nullopt);
  EXPECT_EQ(rate_counted(11'520, 45.0), 256.0);
  EXPECT_EQ(rate_counted(11'520, 9.0), std::nullopt);
  EXPECT_EQ(rate_counted(8'000, 45.0), std::nullopt);
}

}  // namespace
}  // namespace proofmass::io::ximu::ximu_test
