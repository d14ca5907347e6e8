// The sentences are those of the examples in "NMEA Revealed" and of receivers' manuals.
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/io/nmea/reader.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::nmea::nmea_test {
namespace {

const std::string gga = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47";
const std::string rmc = "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A";

TEST(Nmea, ReadsTheSentenceOfTheBook) {
  const auto fix = parse(gga, Kind::gga);
  ASSERT_TRUE(fix);
  EXPECT_DOUBLE_EQ(fix->time_of_day_s, 12 * 3600 + 35 * 60 + 19);
  EXPECT_NEAR(fix->latitude_deg, 48.1173, 1e-9);
  EXPECT_NEAR(fix->longitude_deg, 11.0 + 31.0 / 60.0, 1e-9);
  EXPECT_DOUBLE_EQ(fix->height_m, 545.4);
  EXPECT_DOUBLE_EQ(fix->quality, 1.0);
  EXPECT_DOUBLE_EQ(fix->satellites, 8.0);
  EXPECT_DOUBLE_EQ(fix->hdop, 0.9);
}

TEST(Nmea, ReadsTheMinimumSentence) {
  const auto fix = parse(rmc, Kind::rmc);
  ASSERT_TRUE(fix);
  EXPECT_NEAR(fix->latitude_deg, 48.1173, 1e-9);
  EXPECT_TRUE(std::isnan(fix->height_m));
}

TEST(Nmea, SouthAndWestAreNegative) {
  const auto fix =
      parse("$GNGGA,000001.50,3345.6000,S,15112.0000,W,4,12,0.6,30.0,M,,M,,", Kind::gga);
  ASSERT_TRUE(fix);
  EXPECT_NEAR(fix->latitude_deg, -33.76, 1e-9);
  EXPECT_NEAR(fix->longitude_deg, -151.2, 1e-9);
  EXPECT_DOUBLE_EQ(fix->time_of_day_s, 1.5);
}

TEST(Nmea, RefusesAWrongChecksum) {
  std::string spoilt = gga;
  spoilt[20] = '9';
  EXPECT_FALSE(parse(spoilt, Kind::gga));
}

TEST(Nmea, AFixThatIsNotValidHasNoPosition) {
  const auto fix = parse("$GPGGA,123519,,,,,0,00,,,M,,M,,*6B", Kind::gga);
  ASSERT_TRUE(fix);
  EXPECT_TRUE(std::isnan(fix->latitude_deg));
  EXPECT_EQ(fix->quality, 0.0);
}

TEST(Nmea, ReadsALogAsARecordingAndContinuesOverMidnight) {
  const std::string log =
      "$GPGSV,3,1,11,03,03,111,00*74\r\n"
      "$GPGGA,235959,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPGGA,000000,4807.040,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n"
      "$GPGGA,000001,4807.042,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,\r\n";
  const auto read = read_text(log);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "NMEA");
  ASSERT_EQ(read->samples(), 3u);
  EXPECT_DOUBLE_EQ(read->time.at(2), 2.0);
  ASSERT_NE(read->find("latitude"), nullptr);
  EXPECT_NEAR(read->find("latitude")->values[2], 48.0 + 7.042 / 60.0, 1e-9);
}

TEST(Nmea, ATruncationAtAnyByteIsReadOrRefused) {
  const std::string log = gga + "\r\n" + rmc + "\r\n" + gga + "\r\n";
  for (std::size_t size = 0; size <= log.size(); ++size) {
    const auto read = read_text(log.substr(0, size));
    if (read.has_value()) {
      EXPECT_GE(read->samples(), 1u) << size;
    } else {
      EXPECT_FALSE(read.error().message.empty()) << size;
    }
  }
}

}  // namespace
}  // namespace proofmass::io::nmea::nmea_test
