#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

#include "proofmass/estimate/wheel/gyro_jerk.hpp"
#include "proofmass/estimate/wheel/model.hpp"
#include "proofmass/estimate/wheel_test_support.hpp"

// Gyroscopes on wheels of vehicles: pushes, turns, inclined axles.
namespace proofmass::estimate::wheel_gyroscope_test {
namespace {

using test::Drive;
using test::Mount;
using test::record_with_gyroscope;
using test::Site;

/// The rate at which a vehicle turns about the vertical, half a turn and back, after 20 s.
double turning_radps(double t_s) {
  constexpr double begin_s = 20.0, each_s = 1.5, most_radps = 3.0;
  const double phase = (t_s - begin_s) / each_s;
  return phase > 0.0 && phase < 2.0 ? most_radps * std::sin(test::pi * phase) : 0.0;
}

double straight(double) {
  return 0.0;
}

const Mount mount{.noise_mps2 = 0.1}, shaken{.noise_mps2 = 0.3};

double largest_error_rad(const WheelSolution& solution, const Drive& drive) {
  const WheelSeries& series = solution.series;
  double most = 0.0;
  for (std::size_t k = 0; k < series.time_s.size(); ++k)
    most = std::max(most, std::abs(series.angle_rad[k] - drive.at(series.time_s[k]).angle_rad));
  return most;
}

// A wheelchair: camber of 17 degrees. The turn adds 3 sin 17° · 3 / π rad to the gyroscope's
// integral.
TEST(WheelGyroscope, AVehicleThatTurnsOnTheSpotDoesNotTurnItsWheels) {
  const Drive drive{{0.3, 0.0}, {{1.0, 0.0}, {2.0, 6.0}, {16.0, 2.0}, {1.0, 0.5}, {5.0, 0.5}}};
  const Site site{.axle_tilt_rad = 0.3};
  const auto solution =
      estimate_wheel({record_with_gyroscope(drive, mount, 200.0, site, turning_radps)}, {}).value();
  EXPECT_TRUE(solution.sensors[0].has_gyro);
  EXPECT_LT(largest_error_rad(solution, drive), 0.1);
  for (std::size_t k = 0; k < solution.series.time_s.size(); ++k)
    ASSERT_LT(
        std::abs(solution.series.angle_rad[k] - drive.at(solution.series.time_s[k]).angle_rad),
        4.0 * solution.series.angle_std_rad[k])
        << solution.series.time_s[k];
}

TEST(WheelGyroscope, PushesOfAVehicleShowItsRollingRadius) {
  const Drive drive = test::pushes();
  const Site site{.rolling_radius_m = 0.3};
  WheelOptions options;
  options.bandwidth_hz = 1e4;  // the simulated sensor has no filter
  const auto solution =
      estimate_wheel({record_with_gyroscope(drive, shaken, 200.0, site, straight)}, options)
          .value();
  EXPECT_LT(largest_error_rad(solution, drive), 0.03);
  ASSERT_TRUE(solution.rolling_radius_m);
  EXPECT_NEAR(solution.rolling_radius_m->value, 0.3, 4.0 * solution.rolling_radius_m->std);
  EXPECT_LT(solution.rolling_radius_m->std, 0.02);
  ASSERT_TRUE(solution.sensors[0].gyro_scale);
  EXPECT_NEAR(solution.sensors[0].gyro_scale->value, 1.0,
              4.0 * solution.sensors[0].gyro_scale->std);
}

TEST(WheelGyroscope, AWheelOnABenchHasNoRollingRadius) {
  const Drive drive{{0.3, 0.0}, {{2.0, 0.0}, {4.0, 9.0}, {10.0, 9.0}, {4.0, 0.0}}};
  const auto solution =
      estimate_wheel({record_with_gyroscope(drive, mount, 200.0, {}, straight)}, {}).value();
  EXPECT_LT(largest_error_rad(solution, drive), 0.1);
  EXPECT_FALSE(solution.rolling_radius_m);
}

// The first epochs, where the state explains everything, made the gyroscope's noise half of what it
// is: its innovations had twice their standard deviation.
TEST(WheelGyroscope, ItsNoiseIsThatOfItsMeasurements) {
  const Drive drive{{0.3, 0.0}, {{2.0, 4.0}, {10.0, 9.0}, {10.0, 4.0}}};
  const auto solution =
      estimate_wheel({record_with_gyroscope(drive, mount, 100.0, {}, straight)}, {}).value();
  const auto sum = [](const auto& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  EXPECT_NEAR(sum(solution.series.nis) / sum(solution.series.channels_used), 1.0, 0.1);
}

TEST(MeanAccel, IsThatOfTheSpeedsWithinAFifthOfASecond) {
  std::vector<double> time_s;
  std::vector<Mat<wheel::moving>> moving;
  for (int k = 0; k < 100; ++k) {
    const double t = 0.01 * k + (k > 50 ? 1.0 : 0.0);  // a gap of a second
    time_s.push_back(t);
    moving.emplace_back(0.0, 3.0 * t * t, 100.0, 0.0);
  }
  const std::vector<double> mean = mean_accel_radps2(time_s, moving);
  ASSERT_EQ(mean.size(), time_s.size());
  EXPECT_NEAR(mean[25], 6.0 * time_s[25], 1e-9);
  EXPECT_NEAR(mean[0], 3.0 * 0.2, 1e-9);  // over the first 0.2 s
  EXPECT_NEAR(mean[51], 3.0 * (time_s[51] + time_s[71]), 1e-9);
  EXPECT_EQ(mean_accel_radps2({1.0}, {moving[0]})[0], 100.0);
}

TEST(GyroJerk, IsZeroForNoise) {
  test::Normal normal(1);
  GyroJerk jerk(200.0, 1e-4);
  for (int k = 0; k < 200; ++k) EXPECT_LT(jerk.add(k / 200.0, 5.0 + 0.001 * k), 1e-9);
  int above = 0;
  for (int k = 0; k < 2000; ++k)
    above += jerk.add(1.0 + k / 200.0, 0.01 * normal()) > 100.0 ? 1 : 0;
  EXPECT_LT(above, 200);
}

TEST(GyroJerk, IsTheDensityOfWhiteJerk) {
  constexpr double rate_hz = 500.0, psd = 1e4;
  test::Normal normal(2);
  GyroJerk jerk(rate_hz, 0.0);
  double accel = 0.0, speed = 0.0, sum = 0.0;
  constexpr int count = 20'000;
  for (int k = 0; k < count; ++k) {
    accel += std::sqrt(psd / rate_hz) * normal();
    speed += accel / rate_hz;
    sum += jerk.add(k / rate_hz, speed) / count;
  }
  EXPECT_THAT(sum, testing::AllOf(testing::Gt(0.5 * psd), testing::Lt(5.0 * psd)));
}

TEST(GyroJerk, DecaysAfterAnIrregularityAndSeesNoStepAcrossAGap) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  GyroJerk jerk(100.0, 1e-4);
  double most = 0.0, last = 0.0;
  for (int k = 0; k < 100; ++k) {
    last = jerk.add(0.01 * k, k < 30 ? 0.0 : 2.0);
    most = std::max(most, last);
  }
  EXPECT_GT(most, 1e5);
  EXPECT_LT(last, 1e-6 * most);
  for (int k = 100; k < 103; ++k) (void)jerk.add(0.01 * k, missing);
  for (int k = 103; k < 113; ++k) EXPECT_LT(jerk.add(0.01 * k, 9.0), 1e-6 * most);
  for (int k = 116; k < 126; ++k) EXPECT_LT(jerk.add(0.01 * k, 2.0), 1e-6 * most);  // rows lost
  // Gaps of a row, every fourth, hide no jerk.
  double seen = 0.0;
  for (int k = 126; k < 156; ++k)
    if (k % 4 != 0) seen = std::max(seen, jerk.add(0.01 * k, k < 146 ? 2.0 : 4.0));
  EXPECT_GT(seen, 0.5 * most);
}

TEST(GyroJerk, IgnoresASingleOutlierIfItNeedsTwoMeasurements) {
  GyroJerk jerk(100.0, 1e-4, GyroJerk::Evidence::two);
  for (int k = 0; k < 100; ++k)
    EXPECT_LT(jerk.add(0.01 * k, k == 50 ? 30.0 : 2.0 + 0.01 * k), 1e-9) << k;
}

}  // namespace
}  // namespace proofmass::estimate::wheel_gyroscope_test
