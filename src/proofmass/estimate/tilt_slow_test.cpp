#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"

// How often bands of 95 % hold what is true.
namespace proofmass::estimate::tilt_slow_test {
namespace {

struct Coverage {
  int inside = 0, all = 0;
  void add(double value, double std, double truth) {
    inside += std::abs(value - truth) <= 1.959964 * std ? 1 : 0;
    ++all;
  }
  [[nodiscard]] double share() const { return static_cast<double>(inside) / all; }
};

TEST(TiltCoverage, AtRestIsNinetyFivePercent) {
  Coverage roll, pitch;
  for (std::uint64_t run = 0; run < 4000; ++run) {
    const auto solution = estimate_tilt(still_record(force_at(0.3, -0.2), 0.02, 400, run),
                                        {.gravity_mps2 = {9.80665, 1e-3}, .base = TiltBase::still});
    ASSERT_TRUE(solution);
    roll.add(solution->final.roll_rad->value, solution->final.roll_rad->std, 0.3);
    pitch.add(solution->final.pitch_rad->value, solution->final.pitch_rad->std, -0.2);
  }
  EXPECT_NEAR(roll.share(), 0.95, 0.02);
  EXPECT_NEAR(pitch.share(), 0.95, 0.02);
}

TEST(TiltCoverage, AtRestWithAnUncertainCalibrationIsNinetyFivePercent) {
  Coverage roll, pitch;
  TiltOptions options{.gravity_mps2 = {9.80665, 0.02}, .base = TiltBase::still};
  options.calibration.emplace();
  options.calibration->bias = sensor::make_axis_figures({0.0, 0.0, 0.0}, "m/s^2", "test");
  for (auto& bias : options.calibration->bias) bias->std = 0.02;
  Random random(1, "bias");
  for (std::uint64_t run = 0; run < 4000; ++run) {
    const Mat<3> bias(0.02 * random.normal(), 0.02 * random.normal(), 0.02 * random.normal());
    const auto solution =
        estimate_tilt(still_record(force_at(0.3, -0.2) + bias, 0.02, 200, run), options);
    ASSERT_TRUE(solution);
    roll.add(solution->final.roll_rad->value, solution->final.roll_rad->std, 0.3);
    pitch.add(solution->final.pitch_rad->value, solution->final.pitch_rad->std, -0.2);
  }
  EXPECT_NEAR(roll.share(), 0.95, 0.02);
  EXPECT_NEAR(pitch.share(), 0.95, 0.02);
}

// Shares of instants 2 s apart, of roll and pitch together.
void expect_moving_coverage(const MovingOptions& base_options, double rate_scale_std) {
  Coverage smoothed, filtered;
  for (std::uint64_t run = 0; run < 250; ++run) {
    const MovingBase base = moving_base(base_options, 5000 + run);
    const auto solution = estimate_tilt(base.record, {.gravity_mps2 = {9.80665, 1e-3},
                                                      .base = TiltBase::moving,
                                                      .rate_scale_std = rate_scale_std});
    ASSERT_TRUE(solution);
    const TiltSeries& s = solution->series;
    for (std::size_t k = 300; k + 150 < base_options.samples; k += 200) {
      smoothed.add(s.roll_rad[k], s.roll_std_rad[k], base.roll_rad[k]);
      smoothed.add(s.pitch_rad[k], s.pitch_std_rad[k], base.pitch_rad[k]);
      filtered.add(s.filtered_roll_rad[k], s.filtered_roll_std_rad[k], base.roll_rad[k]);
      filtered.add(s.filtered_pitch_rad[k], s.filtered_pitch_std_rad[k], base.pitch_rad[k]);
    }
  }
  EXPECT_NEAR(smoothed.share(), 0.95, 0.02);
  EXPECT_NEAR(filtered.share(), 0.95, 0.02);
}

TEST(TiltCoverage, OnAMovingBaseWithGyroscopeAndRestsIsNinetyFivePercent) {
  expect_moving_coverage({.rest_s = 1.5}, 0.0);
}

TEST(TiltCoverage, OnAMovingBaseWithGyroscopeAndNoRestIsNinetyFivePercent) {
  expect_moving_coverage({}, 0.0);
}

TEST(TiltCoverage, OnAMovingBaseWithoutGyroscopeIsNinetyFivePercent) {
  expect_moving_coverage({.angular_accel_radps2_rthz = 0.5, .gyroscope = false}, 0.0);
}

}  // namespace
}  // namespace proofmass::estimate::tilt_slow_test
