#include "proofmass/estimate/tilt/axis.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "proofmass/core/random.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/axis_model.hpp"

namespace proofmass::estimate::tilt_axis_test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Swing {
  AxisTiltRecord record;
  std::vector<double> truth_rad;
};

Swing swing(std::size_t samples, std::uint64_t seed) {
  Random random(seed, "swing");
  Swing out;
  constexpr double h = 0.002, amplitude = 0.3, speed = 2.0 * std::numbers::pi;
  double motion = 0.0;
  const double phi = std::exp(-h / 0.01);
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = h * static_cast<double>(k);
    motion = phi * motion + 0.03 * std::sqrt(1.0 - phi * phi) * random.normal();
    out.truth_rad.push_back(amplitude * std::sin(speed * t));
    out.record.time_s.push_back(t);
    out.record.angle_rad.push_back(out.truth_rad.back() + motion + 0.01 * random.normal());
    out.record.rate_radps.push_back(amplitude * speed * std::cos(speed * t) + 0.05 +
                                    2e-3 / std::sqrt(h) * random.normal());
  }
  return out;
}

TEST(AxisTilt, FindsAngleAndBiasThroughTheMotionAndTheNoise) {
  const Swing made = swing(5000, 1);
  const auto solution = estimate_axis_tilt(made.record, {.rate_scale_std = 0.0});
  ASSERT_TRUE(solution) << solution.error().message;
  Moments filtered, smoothed, raw;
  for (std::size_t k = 500; k < made.truth_rad.size(); ++k) {
    raw.add(made.record.angle_rad[k] - made.truth_rad[k]);
    filtered.add(solution->series.filtered_angle_rad[k] - made.truth_rad[k]);
    smoothed.add(solution->series.angle_rad[k] - made.truth_rad[k]);
  }
  EXPECT_LT(filtered.std(), 0.2 * raw.std());
  EXPECT_LT(smoothed.std(), 0.7 * filtered.std());
  EXPECT_NEAR(solution->rate_bias_radps.value, 0.05, 4.0 * solution->rate_bias_radps.std);
  EXPECT_NEAR(solution->noise.motion_std_rad, 0.03, 0.006);
  EXPECT_NEAR(solution->noise.motion_time_s, 0.01, 0.004);
  EXPECT_NEAR(solution->consistency.nis, 1.0, 0.1);
}

TEST(AxisTilt, CountsTheAngleOnFromTurnToTurn) {
  Swing made = swing(2000, 2);
  for (double& angle : made.record.angle_rad) {
    angle += 3.1;
    angle -= 2.0 * std::numbers::pi * std::round(angle / (2.0 * std::numbers::pi));
  }
  const auto solution = estimate_axis_tilt(made.record, {});
  ASSERT_TRUE(solution) << solution.error().message;
  const double off = solution->series.angle_rad[1500] - made.truth_rad[1500] - 3.1;
  EXPECT_NEAR(std::remainder(off, 2.0 * std::numbers::pi), 0.0, 0.02);
  EXPECT_LT(std::abs(solution->series.angle_rad[1500] - solution->series.angle_rad[1400]), 1.0);
}

TEST(AxisTilt, BridgesRowsWithoutReadings) {
  Swing made = swing(3000, 3);
  for (std::size_t k = 1000; k < 1100; ++k) made.record.angle_rad[k] = none;
  for (std::size_t k = 2000; k < 2003; ++k) made.record.rate_radps[k] = none;
  const auto solution = estimate_axis_tilt(made.record, {});
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->unusable, 103U);
  for (std::size_t k = 900; k < 2100; ++k)
    EXPECT_NEAR(solution->series.angle_rad[k], made.truth_rad[k], 0.03) << k;
}

TEST(AxisTilt, SaysWhyItCannot) {
  Swing made = swing(40, 4);
  EXPECT_NE(estimate_axis_tilt(made.record, {}).error().message.find("at least 50"),
            std::string::npos);
  made.record.rate_radps.pop_back();
  EXPECT_EQ(estimate_axis_tilt(made.record, {}).error().message, "channels of different length");
}

TEST(AxisTiltModel, HasTheSameNoiseOverTwoStepsAsOverOneOfTheirLength) {
  const AxisTiltEpochs epochs{
      .step_s = {0.0, 0.01, 0.01, 0.02}, .rate_radps = {0, 0, 0, 0}, .angle_rad = {0, 0, 0, 0}};
  const AxisTiltModel model(epochs,
                            {.rate_noise_radps_rthz = 0.01,
                             .rate_bias_walk_radps_rts = 0.02,
                             .motion_std_rad = 0.1,
                             .motion_time_s = 0.05,
                             .reading_std_rad = 0.01},
                            {});
  const auto one = model.transition(Mat<3>::Zero(), 1), two = model.transition(Mat<3>::Zero(), 3);
  EXPECT_NEAR((one.F * one.Q * one.F.transpose() + one.Q - two.Q).norm(), 0.0, 1e-16);
  EXPECT_NEAR((one.F * one.F - two.F).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace proofmass::estimate::tilt_axis_test
