// Published recordings of sensors turned by hand, at rest or on a wheel; see published_data.hpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/io/read_recording.hpp"
#include "proofmass/signal/rests.hpp"
#include "published_data.hpp"

namespace proofmass::rests_real_test {
namespace {

using signal::find_rests;
using signal::Rest;
using signal::RestSearch;

using Vector = std::array<double, 3>;

struct Accelerometer {
  double rate_hz = 0.0;
  std::array<std::vector<double>, 3> axis{};

  [[nodiscard]] RestSearch search(std::size_t first = 0,
                                  std::size_t count = std::string::npos) const {
    std::vector<View<double>> views;
    for (const std::vector<double>& values : axis)
      views.push_back(View<double>(values).subspan(first, std::min(count, values.size() - first)));
    return find_rests(views, {.rate_hz = rate_hz});
  }
  [[nodiscard]] Vector mean_over(const Rest& rest) const {
    Vector mean{};
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = rest.first; k <= rest.last; ++k) mean[a] += axis[a][k];
      mean[a] /= static_cast<double>(rest.last - rest.first + 1);
    }
    return mean;
  }
};

Accelerometer read(const std::filesystem::path& file,
                   double rate_hz,
                   const std::array<std::string, 3>& names = {"x", "y", "z"}) {
  const Recording recording = io::read_recording(file.string(), {.rate_hz = rate_hz}).value();
  Accelerometer read{.rate_hz = rate_hz};
  for (std::size_t a = 0; a < 3; ++a)
    for (const Channel& channel : recording.channels)
      if (channel.name == names[a]) read.axis[a] = channel.values.copy();
  for (const std::vector<double>& values : read.axis) EXPECT_FALSE(values.empty()) << file;
  return read;
}

double share_of(const Rest& rest, std::size_t first, std::size_t last) {
  const double from = static_cast<double>(std::max(rest.first, first));
  const double to = static_cast<double>(std::min(rest.last, last)) + 1.0;
  return std::max(0.0, to - from) / static_cast<double>(last - first + 1);
}

double norm(const Vector& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// The parameters are those of imu_tk for its own 38 rests, and the angles of an independent fit.
TEST(RestsOfImuTk, AreThirtyEightAndHaveTheNormOfGravity) {
  const auto file = published_data() / "imu-tk-xsens" / "xsens_acc.mat.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Accelerometer sensor = read(file, 100.0);
  const RestSearch search = sensor.search();
  // One rest is disturbed shortly before its end, to another level.
  EXPECT_GE(search.rests.size(), 38U);
  EXPECT_LE(search.rests.size(), 39U);
  EXPECT_LT(search.rests[0].first, 10U);
  EXPECT_NEAR(static_cast<double>(search.rests[0].last), 5240.0, 30.0);
  for (const double std : search.noise_std) EXPECT_NEAR(std, 3.3, 0.3);

  constexpr Vector bias{33123.8, 33275.2, 32364.5};
  constexpr Vector scale{414.418, 412.031, 414.622};
  double squares = 0.0;
  for (const Rest& rest : search.rests) {
    Vector f = sensor.mean_over(rest);
    for (std::size_t a = 0; a < 3; ++a) f[a] = (f[a] - bias[a]) / scale[a];
    f[0] += -3.39e-3 * f[1] - 9.17e-3 * f[2];
    f[1] += -21.36e-3 * f[2];
    const double residual = norm(f) - 9.81744;
    EXPECT_LT(std::abs(residual), 3.5e-3) << rest.first;
    squares += residual * residual;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(search.rests.size())), 0.98e-3, 0.1e-3);
}

// The six intervals at rest as labelled by the owner, with rotations in between.
TEST(RestsOfImucal, AreTheMarkedOnes) {
  const auto file = published_data() / "imucal-ferraris" / "annotated_session.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const RestSearch search = read(file, 204.8, {"acc_x", "acc_y", "acc_z"}).search();
  for (const Rest marked : {Rest{0, 1060}, Rest{1061, 2088}, Rest{3394, 4241}, Rest{4242, 4975},
                            Rest{6069, 7112}, Rest{7113, 7993}}) {
    double most = 0.0;
    for (const Rest& rest : search.rests)
      most = std::max(most, share_of(rest, marked.first, marked.last));
    EXPECT_GT(most, 0.93) << marked.first;
  }
}

// The published 6-parameter fit of the same recording has residuals of 5.3 mm/s² rms.
TEST(RestsOfAPhone, HaveTheNormOfGravity) {
  const auto file =
      published_data() / "tyrex-phones" / "calib_acc_Nexus5_d1" / "accelerometer.txt.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Accelerometer phone = read(file, 198.6);
  const RestSearch search = phone.search();
  EXPECT_GE(search.rests.size(), 9U);
  EXPECT_LE(search.rests.size(), 13U);
  constexpr Vector bias{0.022, 0.143, -0.162};
  constexpr Vector gain{1.0024, 1.0050, 0.9999};
  double squares = 0.0;
  for (const Rest& rest : search.rests) {
    Vector f = phone.mean_over(rest);
    for (std::size_t a = 0; a < 3; ++a) f[a] = (f[a] - bias[a]) * gain[a];
    squares += (norm(f) - 9.8049) * (norm(f) - 9.8049);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(search.rests.size())), 7.5e-3);
}

TEST(RestsOfARestingSensor, AreOne) {
  for (int run = 1; run <= 30; ++run) {
    const auto file = published_data() / "uca-mpu9250" / "start-up" /
                      ("start_up_data_" + std::to_string(run) + ".csv.xz");
    if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
    const Accelerometer sensor = read(file, 180.0);
    const RestSearch search = sensor.search();
    ASSERT_EQ(search.rests.size(), 1U) << run;
    EXPECT_GT(share_of(search.rests[0], 0, sensor.axis[0].size() - 1), 0.98) << run;
  }
}

TEST(RestsOfAWheel, LieBeforeAndAfterItTurns) {
  for (const char* name : {"IMU1", "IMU1_radial", "IMU2", "IMU2_radial", "IMU3", "IMU3_radial"}) {
    const auto file =
        published_data() / "wid-car-wheels" / "trial06" / (name + std::string(".csv.xz"));
    if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
    const Accelerometer wheel = read(file, 120.005, {"Acc_X", "Acc_Y", "Acc_Z"});
    const RestSearch search = wheel.search();
    EXPECT_GE(search.rests.size(), 2U) << name;
    for (const Rest& rest : search.rests)
      EXPECT_TRUE(rest.last < 1500 || rest.first > 6500) << name << " " << rest.first;
    EXPECT_TRUE(wheel.search(2000, 4000).rests.empty()) << name;
  }
}

TEST(RestsOfAWalk, AreNone) {
  const auto file =
      published_data() / "tyrex-phones" / "Guillaume_Nexus5_NoDist_AR" / "accelerometer.txt.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const RestSearch search = read(file, 198.6).search();
  EXPECT_TRUE(search.rests.empty());
  EXPECT_NE(search.why_none.find("was never at rest"), std::string::npos) << search.why_none;
}

}  // namespace
}  // namespace proofmass::rests_real_test
