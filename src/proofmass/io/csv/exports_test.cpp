// Tables as written by third-party apps and loggers.
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::csv_exports_test {
namespace {

// --- Gulf Coast Data Concepts --------------------------------------------------------------------

std::string logger_text(const std::string& dead_band = "0", const std::string& first = "0.5") {
  std::string text =
      ";Title, http://www.gcdataconcepts.com, x2-2,Kionix KXRB5-2050\r\n"
      ";Version, 1102, Build date, Oct  6 2015,  SN:CCDC10023F56AE8\r\n"
      ";Start_time, 2018-02-09, 08:21:42.830\r\n"
      ";Temperature, -999.00, deg C,  Vbat, 4222, mv\r\n;Gain, high\r\n;SampleRate, 64,Hz\r\n"
      ";Deadband, " +
      dead_band + ", counts\r\n;DeadbandTimeout, 0,sec\r\n;Headers, time,Ax,Ay,Az\r\n";
  const double begin = std::stod(first);
  for (int k = 0; k < 100; ++k)
    text +=
        std::to_string(begin + k / 64.0) + ",-20,-190," + std::to_string(-13'022 - k % 5) + "\r\n";
  return text + "; 21 stopping logging: shutdown: switched off\r\n";
}

TEST(LoggerOfGulfCoast, BeginsAtItsStartTime) {
  const auto read = read_text(logger_text());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 100u);
  EXPECT_EQ(read->channels[2].name, "Az");
  EXPECT_EQ(read->channels[2].unit.quantity, Quantity::counts);
  EXPECT_NEAR(read->time.rate_hz, 64.0, 0.01);
  EXPECT_EQ(read->time.start_ns, 1'518'164'503'330'000'000);
  EXPECT_TRUE(is_noted(*read, "Gulf Coast Data Concepts x2-2 (Kionix KXRB5-2050), gain high"))
      << notes_of(*read);
}

TEST(LoggerOfGulfCoast, StampsSince1970AreNotMovedAgain) {
  const auto read = read_text(logger_text("0", "1518164503.5"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.start_ns, 1'518'164'503'500'000'000);
}

TEST(LoggerOfGulfCoast, TellsItsDeadBand) {
  EXPECT_TRUE(is_noted(read_text(logger_text("12")).value(), "dead band of 12 counts"));
  EXPECT_FALSE(is_noted(read_text(logger_text("0")).value(), "dead band"));
}

// --- Physics Toolbox -----------------------------------------------------------------------------

TEST(PhysicsToolbox, ReadsItsClockAndUnits) {
  std::string text = "time,gFx,gFy,gFz,TgF\n";
  for (int k = 0; k < 200; ++k) {
    const int ms = (k % 100) * 10;
    text += "13:05:1" + std::to_string(k / 100) + ":" + (ms < 100 ? "0" : "") +
            (ms < 10 ? "0" : "") + std::to_string(ms) + ",0.01,0.02,1.0,1.0\n";
  }
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_NEAR(read->time.rate_hz, 100.0, 1e-9);
  EXPECT_EQ(read->find("gFx")->unit.symbol, "g");
  EXPECT_EQ(read->find("TgF")->unit.symbol, "g");
}

TEST(PhysicsToolbox, BeginsWhereItsRemarkSays) {
  std::string text =
      "# sensor:linear_accelerometer\n# Requested Sample Rate: 50 Hz\n"
      "# Recording started at: 2026-09-23 16:53:10.681\n"
      "time,ax (m/s^2),ay (m/s^2),az (m/s^2),aT (m/s^2)\n";
  for (int k = 0; k < 100; ++k) text += std::to_string(0.25 + k * 0.02) + ",0.1,0.2,0.3,0.4\n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.start_ns, 1'790'182'390'931'000'000);
  EXPECT_NEAR(read->time.rate_hz, 50.0, 1e-6);
}

TEST(PhysicsToolbox, LinearAccelerometerIsInMetresPerSecondSquared) {
  std::string text = "time;ax;ay;az;aT\n";
  for (int k = 0; k < 100; ++k)
    text += std::to_string(k / 10) + "," + std::to_string(k % 10) + ";0,01;0,02;0,03;0,04\n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->find("ax")->unit.symbol, "m/s^2");
}

// --- several sensors in one table ----------------------------------------------------------------

/// Science Journal: milliseconds, one column per sensor, one row per stamp, blanks for the others.
std::string journal_text() {
  std::string text = "relative_time,AccX,AccY,AccZ,DecibelSource\n";
  for (int k = 0; k < 400; ++k) {
    const int ms = 20 * k;
    if (k % 10 == 9) {  // one measurement with two stamps
      text += std::to_string(ms) + ",0.25,,,\n" + std::to_string(ms + 1) + ",,0.5,9.81,\n";
    } else {
      text += std::to_string(ms) + ",0.25,0.5,9.81,\n";
    }
    if (k % 3 == 0) text += std::to_string(ms + 7) + ",,,,41.5\n";
  }
  return text;
}

TEST(SeveralSensors, RowsOfTheAccelerometerAlone) {
  const auto read = read_text(journal_text());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->samples(), 400u);
  for (const Channel& channel : read->channels)
    for (const double value : channel.values) ASSERT_EQ(value, channel.values.front());
  EXPECT_NEAR(read->time.rate_hz, 50.0, 1e-9);
  EXPECT_EQ(read->find("AccZ")->unit.symbol, "m/s^2");
  EXPECT_TRUE(is_noted(*read,
                       "134 rows without a figure of these channels are left out, and with "
                       "them DecibelSource"))
      << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "40 readings whose channels fell on two stamps"));
}

TEST(SeveralSensors, ChannelReadsAnother) {
  ReadOptions options;
  options.channels = {"decibelsource"};
  const auto read = read_text(journal_text(), options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 1u);
  EXPECT_EQ(read->samples(), 134u);
  EXPECT_EQ(read->channels[0].values.back(), 41.5);
  EXPECT_NEAR(read->time.rate_hz, 1000.0 / 60.0, 1e-9);
}

TEST(SeveralSensors, InTurnsOfPhysicsToolbox) {
  std::string text = "time,gFx,gFy,gFz,TgF,wx,wy,wz\n";
  for (int k = 0; k < 300; ++k)
    text += std::to_string(k * 0.01) + ",0.1,0.2,1,1,,,\n" + std::to_string(k * 0.01 + 0.004) +
            ",,,,,0.5,0.6,0.7\n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 300u);
  EXPECT_NEAR(read->time.rate_hz, 100.0, 1e-6);
  EXPECT_EQ(read->find("wx"), nullptr);
}

TEST(SeveralSensors, BlanksHereAndThereAreNoOtherSensor) {
  std::string text = "t (s),acc_x (g),temp (degC)\n";
  for (int k = 0; k < 300; ++k)
    text += std::to_string(k * 0.01) + "," + (k % 7 == 0 ? "" : "1") + "," +
            (k % 50 == 0 ? "25" : "") + "\n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 300u);
  EXPECT_EQ(read->channels.size(), 2u);
}

TEST(LastColumn, IsOneThoughItIsBlankInMostRows) {
  std::string text;
  for (int k = 0; k < 100; ++k)
    text += std::to_string(k * 0.01) + ",1,2," + (k % 5 == 0 ? "7" : "") + "\n";
  const auto read = read_text("t (s),acc_x (g),acc_y (g),temp (degC)\n" + text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[2].values[5], 7.0);
  EXPECT_EQ(read->channels[2].name, "temp");
}

// --- Xsens DOT -----------------------------------------------------------------------------------

TEST(XsensDot, PreambleIsPassedOver) {
  std::string text =
      "sep=,\nDeviceTag:,Xsens DOT 1\nFirmwareVersion:,2.0.0\nAppVersion:,v2022.0.0\n"
      "SyncStatus:,Synced\nOutputRate:,60Hz\nFilterProfile:,General\n"
      "Measurement Mode:,Sensor fusion Mode - Complete (Euler)\n\n"
      "PacketCounter,SampleTimeFine,Euler_X,Euler_Y,Euler_Z,Acc_X,Acc_Y,Acc_Z,\n";
  for (int k = 0; k < 200; ++k)
    text += std::to_string(k) + ", " + std::to_string(1'000'000 + k * 16'667) +
            ", 0.5, 0.6, 0.7, 0.1, 0.2, 9.8, \n";
  const auto read = read_text(text);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels.size(), 7u);
  EXPECT_NEAR(read->time.rate_hz, 59.9988, 1e-3);
  EXPECT_EQ(read->find("Acc_Z")->unit.symbol, "m/s^2");
}

}  // namespace
}  // namespace proofmass::io::csv_exports_test
