// A car's wheels with position fixes that wander: the line through them is a quarter too long.
// Wheels 1 and 3 are in front, 1 and 2 on the right.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/estimate/drive.hpp"
#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::drive_real_test {
namespace {

std::filesystem::path folder_of(const char* trial) {
  return published_data() / "wid-car-wheels" / trial;
}

// IMU1 and IMU2 were stamped by one clock, IMU3 by another.
estimate::DriveWheel wheel_of(const char* trial, int number) {
  const std::string name = "IMU" + std::to_string(number) + ".csv.xz";
  const Recording recording = io::read_recording((folder_of(trial) / name).string(), {}).value();
  estimate::DriveWheel wheel;
  wheel.sensor.name = name;
  wheel.side = number <= 2 ? estimate::VehicleSide::right : estimate::VehicleSide::left;
  wheel.steered = number % 2 == 1;
  wheel.clock = number <= 2 ? 0 : 1;
  constexpr double first_s = 2167.0;
  const double begin_s = wheel.clock == 0
                             ? 1e-9 * static_cast<double>(recording.time.start_ns.value()) - first_s
                             : 0.0;
  for (std::size_t k = 0; k < recording.samples(); ++k)
    wheel.sensor.time_s.push_back(begin_s + recording.time.at(k));
  const std::array accel{"Acc_X", "Acc_Y", "Acc_Z"}, rate{"Gyr_X", "Gyr_Y", "Gyr_Z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    wheel.sensor.accel_mps2[axis] = recording.find(accel[axis])->values.copy();
    for (const double value : recording.find(rate[axis])->values)
      wheel.sensor.rate_radps[axis].push_back(value * rad_per_deg);
  }
  return wheel;
}

estimate::GnssFixes fixes_of(const char* trial) {
  const Recording recording =
      io::read_recording((folder_of(trial) / "GNSS.csv.xz").string(), {}).value();
  estimate::GnssFixes fixes{.name = "GNSS", .fixes = {}};
  const auto &lat = recording.find("Lat_GNSS")->values, &lon = recording.find("Long_GNSS")->values;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    if (!std::isfinite(lat[k]) || !std::isfinite(lon[k])) continue;
    const estimate::GnssFix fix{.time_s = recording.time.at(k),
                                .latitude_rad = lat[k] * rad_per_deg,
                                .longitude_rad = lon[k] * rad_per_deg};
    if (fixes.fixes.empty() || fix.latitude_rad != fixes.fixes.back().latitude_rad ||
        fix.longitude_rad != fixes.fixes.back().longitude_rad)
      fixes.fixes.push_back(fix);
  }
  return fixes;
}

// Gyroscopes and accelerometers on the wheels alone; with fixes the distance is 143.3 m.
TEST(CarDrive, TheWheelsShowTheirOwnCircumference) {
  if (!std::filesystem::exists(folder_of("trial06"))) GTEST_SKIP() << absent(folder_of("trial06"));
  std::vector<estimate::DriveWheel> wheels;
  for (const int number : {1, 2, 3}) wheels.push_back(wheel_of("trial06", number));
  const auto solved = estimate::estimate_drive(wheels, std::nullopt, std::nullopt, {});
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  ASSERT_TRUE(solved->distance_m);
  EXPECT_NEAR(solved->distance_m->value, 143.3, 2.5 * solved->distance_m->std);
  EXPECT_LT(solved->distance_m->std, 10.0);
}

TEST(CarDrive, DoesNotFollowTheWanderOfTheFixes) {
  if (!std::filesystem::exists(folder_of("trial06"))) GTEST_SKIP() << absent(folder_of("trial06"));
  std::vector<estimate::DriveWheel> wheels;
  for (const int number : {1, 2, 3}) wheels.push_back(wheel_of("trial06", number));
  const auto solved = estimate::estimate_drive(wheels, std::nullopt, fixes_of("trial06"), {});
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  ASSERT_TRUE(solved->distance_m);
  // The stamps are ten times too long, the line through the fixes a quarter.
  EXPECT_DOUBLE_EQ(solved->fixes->time_scale, 0.1);
  EXPECT_GT(solved->fixes->path_m, 180.0);
  // A least-squares fit of one wheel's dead reckoning to the fixes, by another program, has 143.3
  // m.
  EXPECT_NEAR(solved->distance_m->value, 143.3, 1.0);
  EXPECT_LT(solved->distance_m->std, 1.5);
  // The turns of the wheels were counted by two other methods.
  const std::array turns{79.615, 78.215, 79.924};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(solved->wheels[i].turns->value, turns[i], 0.05) << i;
  for (const auto& wheel : solved->wheels) EXPECT_LT(wheel.spin_tilt_rad, 0.15) << wheel.name;
}

TEST(CarDrive, GivesOneWheelItsHeadingByItsGyroscope) {
  if (!std::filesystem::exists(folder_of("trial10"))) GTEST_SKIP() << absent(folder_of("trial10"));
  const auto solved =
      estimate::estimate_drive({wheel_of("trial10", 1)}, std::nullopt, fixes_of("trial10"), {});
  ASSERT_TRUE(solved.has_value()) << solved.error().message;
  ASSERT_TRUE(solved->distance_m);
  EXPECT_NEAR(solved->distance_m->value, 190.5, 3.0);
  EXPECT_TRUE(solved->heading_change_rad);
}

}  // namespace
}  // namespace proofmass::drive_real_test
