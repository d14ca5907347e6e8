// Third-party HDF5 and MAT 7.3 files, compared with h5py 3.7.
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::hdf5_real_test {
namespace {

const Channel& channel(const Recording& recording, const char* name) {
  const Channel* found = recording.find(name);
  EXPECT_NE(found, nullptr) << name;
  static const Channel none;
  return found == nullptr ? none : *found;
}

TEST(Hdf5Files, OfTheBroadBenchmarkHaveUnitsFromTheirTextAndTheirRate) {
  const auto file =
      published_data() / "broad-translation/14_undisturbed_slow_translation_with_breaks_B.hdf5";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file, {});
  if (!read && read.error().code == Errc::unsupported) GTEST_SKIP() << read.error().message;
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "HDF5");
  EXPECT_EQ(read->samples(), 55'402u);
  ASSERT_EQ(read->channels.size(), 17u);
  EXPECT_DOUBLE_EQ(read->time.rate_hz, 2000.0 / 7.0);
  EXPECT_EQ(channel(*read, "imu_acc_z").unit.symbol, "m/s^2");
  EXPECT_EQ(channel(*read, "imu_gyr_x").unit.symbol, "rad/s");
  EXPECT_EQ(channel(*read, "imu_mag_x").unit.symbol, "uT");
  EXPECT_EQ(channel(*read, "opt_pos_y").unit.symbol, "m");
  EXPECT_EQ(channel(*read, "imu_acc_z").values[12'345], 11.885836125378164);
  EXPECT_EQ(channel(*read, "imu_gyr_x").values[12'345], 0.21838606798504248);
  EXPECT_EQ(channel(*read, "opt_pos_y").values[12'345], -0.5668683959803632);
  EXPECT_EQ(channel(*read, "opt_quat_w").values[12'345], 0.9989145664665343);
  EXPECT_TRUE(std::isnan(channel(*read, "opt_quat_w").values[0]));
  const auto& movement = channel(*read, "movement").values;
  EXPECT_EQ(std::accumulate(movement.begin(), movement.end(), 0.0), 26'641.0);
}

TEST(Hdf5Files, OfMatlabHaveTheTimeInTheirFirstColumn) {
  const auto file =
      published_data() /
      "sunsided-mpu6050/unmoved-with-x-pointing-forward-10min/mpu6050_accelerometer.mat";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file, {});
  if (!read && read.error().code == Errc::unsupported) GTEST_SKIP() << read.error().message;
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "MAT v7.3");
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->samples(), 65'067u);
  EXPECT_NEAR(read->duration_s(), 655.1336609879645, 1e-9);
  const auto& z = read->channels[2].values;
  EXPECT_NEAR(std::accumulate(z.begin(), z.end(), 0.0) / 65'067.0, -1.0340754680031736, 1e-12);
  EXPECT_EQ(read->channels[2].unit.symbol, "g");
}

TEST(Hdf5Files, OfTheMathWorksAreReadAsTheOlderVersionsOfTheSame) {
  const auto folder = published_data() / "formats/mat";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << absent(folder);
  const auto recent = io::read_recording(folder / "testhdf5_7.4_GLNX86.mat", {});
  if (!recent && recent.error().code == Errc::unsupported) GTEST_SKIP() << recent.error().message;
  const auto older = io::read_recording(folder / "testdouble_7.4_GLNX86.mat", {});
  ASSERT_TRUE(recent.has_value() && older.has_value());
  ASSERT_EQ(recent->channels.size(), 1u);
  EXPECT_EQ(recent->channels[0].values, older->channels[0].values);
}

}  // namespace
}  // namespace proofmass::hdf5_real_test
