// A motor's axis with its true angle, a phone with the opposite sign, and static sensors.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <numbers>
#include <string>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt/axis.hpp"
#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::tilt_real_test {
namespace {

constexpr double deg = 180.0 / std::numbers::pi;

std::vector<double> times_of(const Recording& recording) {
  std::vector<double> time_s(recording.samples());
  for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = recording.time.at(k);
  return time_s;
}

/// Standard deviation of the difference in degrees.
double error_deg(const std::vector<double>& angle_rad, const std::vector<double>& truth_rad) {
  Moments error;
  for (std::size_t k = 0; k < angle_rad.size(); ++k) error.add(angle_rad[k] - truth_rad[k]);
  return error.std() * deg;
}

class MotorAxis : public ::testing::TestWithParam<int> {};

TEST_P(MotorAxis, IsBelowTheOtherFilterOnlineAndSmoothed) {
  const std::filesystem::path file =
      published_data() / "mcar-motor-axis" / ("10_18_" + std::to_string(GetParam()) + ".dat.xz");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = io::read_recording(file.string(), {}).value();
  const auto values = [&](const char* name) { return recording.find(name)->values.copy(); };
  const std::vector<double> truth = values("column 5");
  const double other = error_deg(values("column 6"), truth);
  const auto solution = estimate::estimate_axis_tilt({.time_s = times_of(recording),
                                                      .angle_rad = values("column 3"),
                                                      .rate_radps = values("column 2")},
                                                     {});
  ASSERT_TRUE(solution) << solution.error().message;
  const double filtered = error_deg(solution->series.filtered_angle_rad, truth);
  const double smoothed = error_deg(solution->series.angle_rad, truth);
  RecordProperty("other_deg", std::to_string(other));
  RecordProperty("filtered_deg", std::to_string(filtered));
  RecordProperty("smoothed_deg", std::to_string(smoothed));
  EXPECT_LT(filtered, 0.8 * other);
  EXPECT_LT(smoothed, 0.8 * other);
}

INSTANTIATE_TEST_SUITE_P(AllFiles, MotorAxis, ::testing::Values(1, 2, 3, 4));

estimate::TiltRecord record_of(const std::filesystem::path& file, double to_mps2) {
  const Recording recording = io::read_recording(file.string(), {}).value();
  const Triad triad = accelerometer_triads(recording).front();
  estimate::TiltRecord record;
  record.time_s = times_of(recording);
  const std::array axes{triad.x, triad.y, triad.z};
  for (std::size_t i = 0; i < 3; ++i) {
    record.accel_mps2[i] = recording.channels[*axes[i]].values.copy();
    for (double& value : record.accel_mps2[i]) value *= to_mps2;
  }
  return record;
}

TEST(RealTilt, OfASensorThatLiesOnATableIsSmallAndItsBandCountsItsBias) {
  const std::filesystem::path file =
      published_data() / "uca-mpu9250" / "start-up" / "start_up_data_1.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto solution = estimate::estimate_tilt(record_of(file, standard_gravity_mps2), {});
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_FALSE(solution->moving);
  // Its z axis measures 0.77 g: an uncalibrated unit, whose errors cause degrees of tilt.
  ASSERT_TRUE(solution->final.pitch_rad);
  EXPECT_LT(std::abs(solution->final.pitch_rad->value), 3.0 * solution->final.pitch_rad->std);
  EXPECT_GT(solution->final.pitch_rad->std * deg, 5.0);
}

TEST(RealTilt, OfAPhoneOfTheOtherSignStandsOnItsHeadUnlessItIsTurnedRound) {
  const std::filesystem::path file =
      published_data() / "tyrex-phones" / "calib_acc_iPhone5_d3" / "accelerometer.txt.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const estimate::TiltRecord record = record_of(file, -standard_gravity_mps2);
  estimate::TiltOptions options;
  options.base = estimate::TiltBase::still;
  const auto solution = estimate::estimate_tilt(record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  ASSERT_GE(solution->rests.size(), 6U);
  // It starts face up.
  EXPECT_NEAR(solution->rests.front().angles.roll_rad->value * deg, 0.0, 5.0);
  EXPECT_NEAR(solution->rests.front().angles.pitch_rad->value * deg, 0.0, 5.0);
}

}  // namespace
}  // namespace proofmass::tilt_real_test
