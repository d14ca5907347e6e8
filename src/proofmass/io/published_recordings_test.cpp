// Unmodified recordings published by others. They are not part of this repository.
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "proofmass/core/statistics.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::published_recordings_test {
namespace {

struct Published {
  const char* path;
  std::size_t samples;
  double rate_hz;  ///< 0: not given in the file
  const char* unit;
  std::size_t axes;  ///< axes of its first accelerometer; 0: no three-axis one
};

class PublishedRecording : public testing::TestWithParam<Published> {};

TEST_P(PublishedRecording, IsReadAsItsAuthorsDescribeIt) {
  const auto data = published_data();
  if (data.empty()) GTEST_SKIP() << "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder";
  const Published& expected = GetParam();
  const auto read = read_recording(data / expected.path, {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), expected.samples);
  if (expected.rate_hz > 0.0)
    EXPECT_NEAR(read->time.rate_hz, expected.rate_hz, 0.005 * expected.rate_hz);
  else
    EXPECT_EQ(read->time.source, TimeSource::none);
  const auto triads = accelerometer_triads(*read);
  if (expected.axes == 0) return;
  ASSERT_FALSE(triads.empty()) << notes_of(*read);
  EXPECT_EQ(triads[0].axes(), expected.axes);
  EXPECT_EQ(read->channels[*triads[0].x].unit.symbol, expected.unit) << notes_of(*read);
}

constexpr const char* phyphox =
    "phyphox-barbell-strokes/Acceleration without g 2024-01-17 08-15-45/Raw Data.csv.xz";

INSTANTIATE_TEST_SUITE_P(
    All,
    PublishedRecording,
    testing::Values(
        Published{"wid-car-wheels/trial06/IMU1.csv.xz", 10990, 120.0048, "m/s^2", 3},
        Published{"wid-car-wheels/trial06/IMU3_radial.csv.xz", 11038, 120.0048, "m/s^2", 3},
        Published{"wid-car-wheels/trial06/CAR.csv.xz", 11034, 120.0048, "m/s^2", 3},
        Published{"wid-car-wheels/trial06/GNSS.csv.xz", 9166, 10.0, "g", 3},
        Published{"adis16405-static/adis16405_run1_acc_g.csv.xz", 1'000'000, 0.0, "g", 3},
        Published{"uca-mpu9250/start-up/start_up_data_1.csv.xz", 10821, 182.1, "g", 3},
        Published{"uca-mpu9250/six-position/trial_1/six_position_test_data_1.csv.xz", 10763, 181.4,
                  "g", 3},
        Published{"imu-tk-xsens/xsens_acc.mat.xz", 51175, 100.0, "counts", 3},
        Published{"imu-tk-xsens/IMU0x2Dalpha.mat", 51175, 100.0, "counts", 3},
        Published{"hassan-multiposition/MobileAccData30orientationRawSample01.mat", 8042, 0.0,
                  "m/s^2", 3},
        Published{"imucal-ferraris/annotated_session.csv.xz", 9414, 0.0, "counts", 3},
        Published{"imucal-ferraris/example_ferraris_session.csv.xz", 10376, 0.0, "m/s^2", 3},
        Published{"tyrex-phones/calib_acc_Nexus5_d1/accelerometer.txt.xz", 10596, 198.6, "m/s^2",
                  3},
        Published{"tyrex-phones/calib_acc_iPhone5_d3/accelerometer.txt.xz", 7802, 101.0, "g", 3},
        Published{"repoimu-pendulum/Pendulum_Test03_Trial1_Segment_1.csv.xz", 4199, 163.8, "m/s^2",
                  3},
        Published{"mcar-motor-axis/10_18_1.dat.xz", 3121, 500.0, "", 0},
        Published{phyphox, 3602, 100.0, "m/s^2", 3},
        Published{"phyphox-elevator/series_2/Acceleration.csv.xz", 2825, 26.03, "", 0},
        Published{"xio-ximu/gait/straightLine_CalInertialAndMag.csv.xz", 9963, 0.0, "g", 3},
        Published{"formats/gcdc/DATA-001.CSV", 1375, 64.0, "counts", 3}));

TEST(PublishedWheel, BothUnitsOfAWheelStandOnOneClock) {
  const auto data = published_data();
  if (data.empty()) GTEST_SKIP() << "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder";
  const auto hub = read_recording(data / "wid-car-wheels/trial06/IMU1.csv.xz", {});
  const auto rim = read_recording(data / "wid-car-wheels/trial06/IMU1_radial.csv.xz", {});
  ASSERT_TRUE(hub.has_value() && rim.has_value());
  EXPECT_EQ(hub->time.start_ns, 2'167'082'953'000);
  EXPECT_EQ(rim->time.start_ns, 2'167'049'621'000);
  EXPECT_EQ(hub->first_line, 3u);
}

/// The rows of a wheel's recording, with every tenth of a segment corrupted as by a decoder.
std::string spoilt(const std::string& text) {
  const std::vector<std::string> junk{"nan", "inf", "-inf", "3.0531e+34", "1.4013e-45", "4.9e-324"};
  std::string out;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = text.find('\n', begin);
    const std::string row = text.substr(begin, end - begin);
    begin = end + 1;
    if (line < 100 || line > 400 || line % 10 != 0) {
      out += row + "\n";
      continue;
    }
    // Keeps the packet counter and removes stamp and measurements.
    out += row.substr(0, row.find(',')) + ", ";
    for (std::size_t c = 0; c < 10; ++c) out += junk[(line / 10 + c) % junk.size()] + ", ";
    out += "\n";
  }
  return out;
}

TEST(PublishedWheel, WithCorruptRowsLosesNothingElseAndNamesThem) {
  const auto data = published_data();
  if (data.empty()) GTEST_SKIP() << "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder";
  const auto clean = read_recording(data / "wid-car-wheels/trial06/IMU1.csv.xz", {});
  ASSERT_TRUE(clean.has_value());
  std::string text =
      "sep=,\nPacketCounter,SampleTimeFine,Euler_X,Euler_Y,Euler_Z,Acc_X,Acc_Y,Acc_Z,"
      "Gyr_X,Gyr_Y,Gyr_Z,\n";
  for (std::size_t k = 0; k < clean->samples(); ++k) {
    text += std::to_string(k) + ", " + std::to_string(2'167'082'953 + k * 8'333) + ", ";
    for (std::size_t c = 1; c < clean->channels.size(); ++c)
      text += std::to_string(clean->channels[c].values[k]) + ", ";
    text += "\n";
  }
  const auto whole = read_text(text);
  const auto read = read_text(spoilt(text));
  ASSERT_TRUE(whole.has_value() && read.has_value());
  ASSERT_EQ(read->samples(), clean->samples());
  EXPECT_EQ(read->time.mended, 31u) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "set from PacketCounter")) << notes_of(*read);
  EXPECT_EQ(read->find("PacketCounter")->values, whole->find("PacketCounter")->values);
  std::size_t differing = 0;
  for (std::size_t k = 0; k < read->samples(); ++k) {
    EXPECT_NEAR(read->time.at(k), whole->time.at(k), 1e-9) << k;
    if (read->find("Acc_X")->values[k] != whole->find("Acc_X")->values[k]) ++differing;
  }
  EXPECT_EQ(differing, 31u);
  EXPECT_EQ(read->find("Acc_X")->unit.symbol, "m/s^2");
}

}  // namespace
}  // namespace proofmass::io::published_recordings_test
