#include "proofmass/estimate/tilt.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt/model.hpp"
#include "proofmass/estimate/tilt/rest.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"

namespace proofmass::estimate::tilt_test {
namespace {

TEST(Tilt, OfNoiseFreeReadingsIsExact) {
  TiltRecord record = still_record(force_at(0.4, -0.3), 1e-9, 300, 1);
  const auto solution = estimate_tilt(record, exact);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_NEAR(solution->final.roll_rad->value, 0.4, 1e-10);
  EXPECT_NEAR(solution->final.pitch_rad->value, -0.3, 1e-10);
}

TEST(Tilt, AtRestIsThatOfTheMeanForceAndItsStandardError) {
  const TiltRecord record = still_record(force_at(0.1, 0.2), 0.02, 4000, 2);
  const auto solution = estimate_tilt(record, exact);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_FALSE(solution->moving);
  const Uncertain roll = *solution->final.roll_rad, pitch = *solution->final.pitch_rad;
  EXPECT_NEAR(roll.value, 0.1, 4.0 * roll.std);
  EXPECT_NEAR(pitch.value, 0.2, 4.0 * pitch.std);
  EXPECT_NEAR(pitch.std, 0.02 / std::sqrt(4000.0) / 9.80665, 0.4 * pitch.std);
}

TEST(Tilt, AtRestCountsCorrelatedNoise) {
  Random random(3, "correlated");
  std::vector<double> values;
  double noise = 0.0;
  for (int k = 0; k < 20000; ++k) values.push_back(noise = 0.95 * noise + random.normal());
  const StretchMean mean = stretch_mean(values, 0.0);
  // For an autoregression the variance of the mean is σ²/(1 − φ)²/N.
  EXPECT_NEAR(std::sqrt(mean.variance), 20.0 / std::sqrt(20000.0), 0.3 * 20.0 / std::sqrt(20000.0));
}

// Forty batches of values that are correlated over a fifth of the interval.
TEST(Tilt, AtRestCountsSlowNoiseBetweenBatches) {
  Random random(31, "wander");
  double squares = 0.0, variances = 0.0;
  for (int run = 0; run < 200; ++run) {
    std::vector<double> values;
    double slow = 10.0 * random.normal();
    const double phi = std::exp(-1.0 / 100.0);
    for (int k = 0; k < 2000; ++k) {
      slow = phi * slow + 10.0 * std::sqrt(1.0 - phi * phi) * random.normal();
      values.push_back(slow + random.normal());
    }
    const StretchMean mean = stretch_mean(values, 0.0);
    squares += square(mean.mean) / 200.0;
    variances += mean.variance / 200.0;
  }
  EXPECT_GT(variances, 0.7 * squares);
  EXPECT_LT(variances, 2.0 * squares);
}

// A sinusoidal vibration of 1.5 steps leaves more rounding error than Gaussian noise of equal
// variance.
TEST(Tilt, AHumDithersTheRoundingAwayOnlyInPart) {
  double squares = 0.0, variances = 0.0;
  constexpr int levels = 50;
  for (int level = 0; level < levels; ++level) {
    std::vector<double> values;
    const double truth = static_cast<double>(level) / levels;
    for (int k = 0; k < 1000; ++k) values.push_back(std::round(truth + 1.5 * std::sin(0.7 * k)));
    const StretchMean mean = stretch_mean(values, 1.0);
    squares += square(mean.mean - truth) / levels;
    variances += mean.rounding / levels;
  }
  EXPECT_GT(squares, 1e-4);
  EXPECT_GT(variances, 0.5 * squares);
  EXPECT_LT(variances, 1.0 / 12.0);
}

TEST(Tilt, AQuietStretchWithAChangingLevelIsNotARest) {
  // Vibration of 0.3 m/s², and a slow acceleration of 2 m/s² with a period of ten seconds.
  const MovingBase base = moving_base({.samples = 6000,
                                       .accel_std_mps2 = 0.0,
                                       .sway_mps2 = 2.0,
                                       .slowest_sway_hz = 0.1,
                                       .fastest_sway_hz = 0.1,
                                       .turning = 0.0,
                                       .reading_std_mps2 = 0.3,
                                       .gyroscope = false},
                                      32);
  const TiltSolution solution = estimate_tilt(base.record, exact).value();
  EXPECT_TRUE(solution.moving);
  double within = 0.0;
  for (std::size_t k = 0; k < base.pitch_rad.size(); ++k)
    within += std::abs(solution.series.pitch_rad[k] - base.pitch_rad[k]) <
                      1.96 * solution.series.pitch_std_rad[k]
                  ? 1.0
                  : 0.0;
  EXPECT_GT(within, 0.9 * static_cast<double>(base.pitch_rad.size()));
}

TEST(Tilt, ASwingThatNeverStopsIsNotARest) {
  TiltRecord record;
  Random random(52, "swing");
  for (int k = 0; k < 6000; ++k) {
    const double t = 0.01 * k;
    const Mat<3> f = force_at(0.3 * std::sin(5.0 * t) + 0.2 * std::sin(7.9 * t),
                              0.3 * std::sin(3.3 * t) + 0.2 * std::sin(9.1 * t));
    record.time_s.push_back(t);
    for (int i = 0; i < 3; ++i)
      record.accel_mps2[static_cast<std::size_t>(i)].push_back(f(i) + 0.5 * random.normal());
  }
  EXPECT_TRUE(estimate_tilt(record, exact).value().moving);
}

// The vibration dominates the variance of the force, the slow acceleration its low frequencies.
TEST(Tilt, ASlowAccelerationBesideVibrationIsNotTilt) {
  for (unsigned seed = 61; seed < 66; ++seed) {
    const MovingBase base = slowly_swayed_base(0.5, seed);
    const TiltSolution solution = estimate_tilt(base.record, exact).value();
    ASSERT_TRUE(solution.moving);
    double largest = 0.0;
    for (std::size_t k = 0; k < base.pitch_rad.size(); ++k)
      largest = std::max(largest, std::abs(solution.series.pitch_rad[k] - base.pitch_rad[k]) /
                                      solution.series.pitch_std_rad[k]);
    EXPECT_LT(largest, 4.0) << seed;
  }
}

TEST(Tilt, ARestKeepsTheDriftOfAWarmSensor) {
  TiltRecord record = still_record(force_at(0.1, 0.2), 0.02, 6000, 33);
  for (std::size_t k = 0; k < 6000; ++k)
    record.accel_mps2[0][k] += 0.01 * static_cast<double>(k) / 6000.0;
  const TiltSolution solution = estimate_tilt(record, exact).value();
  EXPECT_FALSE(solution.moving);
  EXPECT_EQ(solution.rests.size(), 1U);
}

TEST(Tilt, CountsTheStabilityOfTheBiasThatTheSensorFileStates) {
  TiltOptions options = uncalibrated;
  options.calibration.emplace();
  options.calibration->bias = sensor::make_axis_figures({0.0, 0.0, 0.0}, "m/s^2", "test");
  for (auto& bias : options.calibration->bias) bias->std = 1e-4;
  options.calibration->stability = sensor::make_axis_figures({0.03, 0.03, 0.03}, "m/s^2", "test");
  const TiltRecord record =
      still_record(force_at(0.0, 0.0) + Mat<3>(0.0, 0.0, 0.02), 0.01, 500, 34);
  const TiltSolution solution = estimate_tilt(record, options).value();
  EXPECT_NEAR(solution.final.pitch_rad->std, 0.03 / 9.80665, 0.3 * 0.03 / 9.80665);
}

TEST(Tilt, CountsTheCalibrationOfTheSensorFile) {
  TiltOptions options = exact;
  options.bias_std_mps2 = 0.0;
  options.calibration.emplace();
  options.calibration->bias = sensor::make_axis_figures({0.0, 0.0, 0.0}, "m/s^2", "test");
  for (auto& bias : options.calibration->bias) bias->std = 0.05;
  const auto solution = estimate_tilt(still_record(force_at(0.0, 0.0), 0.01, 2000, 4), options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_NEAR(solution->final.pitch_rad->std, 0.05 / 9.80665, 1e-4);
  EXPECT_NEAR(solution->shares.calibration, 0.05 / 9.80665, 1e-5);
}

TEST(Tilt, TakesAnUncalibratedSensorToBeAsFarOffAsItsNormShows) {
  const auto std_of = [](double scale) {
    const TiltRecord record = still_record(scale * force_at(0.0, 0.0), 0.01, 2000, 5);
    const TiltSolution solution = estimate_tilt(record, uncalibrated).value();
    EXPECT_NE(solution.notes.front().text.find("calibration is unknown"), std::string::npos);
    EXPECT_EQ(solution.notes.front().text.find("differs from gravity") != std::string::npos,
              scale != 1.0);
    return solution.final.pitch_rad->std;
  };
  EXPECT_GT(std_of(1.02), 0.02);
  EXPECT_LT(std_of(1.02), 0.06);
  EXPECT_LT(std_of(1.0), 0.01);
}

// The norm of one rest shows only the bias along gravity: it may be right by chance.
TEST(Tilt, StatesTheAccuracyOfAnUncalibratedSensor) {
  Random random(51, "uncalibrated");
  int inside = 0;
  for (unsigned run = 0; run < 200; ++run) {
    const double size = 0.1 * std::exp(random.normal());
    const Mat<3> bias(size * random.normal(), size * random.normal(), size * random.normal());
    const double roll = random.normal(), pitch = 0.4 * random.normal();
    const TiltRecord record = still_record(force_at(roll, pitch) + bias, 0.01, 300, 100 + run);
    const Uncertain found = *estimate_tilt(record, uncalibrated).value().final.pitch_rad;
    if (std::abs(found.value - pitch) < 1.96 * found.std) ++inside;
  }
  EXPECT_GE(inside, 182);
  EXPECT_LE(inside, 199);
}

// Two constant axes and one that alternates between two codes.
TEST(Tilt, CountsWhatACoarseConverterHides) {
  constexpr double step = 0.04;
  TiltRecord record = still_record(force_at(-0.6521, -0.002), 0.05 * step, 1000, 6);
  for (auto& axis : record.accel_mps2)
    for (double& value : axis) value = step * std::round(value / step);
  const auto solution = estimate_tilt(record, exact);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_NEAR(solution->final.roll_rad->value, -0.6521, 2.0 * solution->final.roll_rad->std);
  EXPECT_NEAR(solution->final.roll_rad->std, step / std::sqrt(12.0) / 9.80665, 5e-4);
  for (auto& axis : record.accel_mps2) std::ranges::fill(axis, axis.front());
  const auto stuck = estimate_tilt(record, exact);
  ASSERT_TRUE(stuck) << stuck.error().message;
  EXPECT_FALSE(stuck->final.roll_rad.has_value());
  EXPECT_NE(stuck->final.why_no_roll.find("one and the same value"), std::string::npos);
}

TEST(Tilt, WidensTheBandOfASensorThatHasChangedSinceItsCalibration) {
  TiltOptions options{.gravity_mps2 = {9.80665, 1e-4}};
  options.calibration.emplace();
  options.calibration->bias = sensor::make_axis_figures({0.0, 0.0, 0.0}, "m/s^2", "test");
  for (auto& bias : options.calibration->bias) bias->std = 0.001;
  const auto std_of = [&](const Mat<3>& bias) {
    const auto solution =
        estimate_tilt(still_record(force_at(0.0, 0.0) + bias, 0.01, 2000, 4), options);
    return solution.value().final.pitch_rad->std * 9.80665;
  };
  const double same = std_of(Mat<3>::Zero()), moved = std_of(Mat<3>(0.05, 0.05, 0.05));
  EXPECT_LT(same, 0.01);
  EXPECT_GT(moved, 0.03);
  options.bias_std_mps2 = 0.0;
  EXPECT_NEAR(std_of(Mat<3>::Zero()), 0.001, 2e-4);
}

TEST(Tilt, SaysWhyItCannot) {
  const auto message = [](const TiltRecord& record, const TiltOptions& options) {
    const auto solution = estimate_tilt(record, options);
    return solution ? std::string("done") : solution.error().message;
  };
  EXPECT_EQ(message({}, {}), "no accelerometer axis");
  TiltRecord removed = still_record({0.0, 0.0, 0.1}, 0.01, 300, 11);
  EXPECT_NE(message(removed, {}).find("gravity was removed"), std::string::npos);
  TiltRecord counts = still_record({0.0, 0.0, 32768.0}, 1.0, 300, 12);
  EXPECT_NE(message(counts, {}).find("its unit is another"), std::string::npos);
  TiltRecord empty = still_record({none, none, none}, 0.0, 300, 13);
  EXPECT_NE(message(empty, {}).find("no sample"), std::string::npos);
  TiltRecord backwards = still_record(force_at(0.0, 0.0), 0.01, 300, 14);
  backwards.time_s[100] = 0.0;
  EXPECT_NE(message(backwards, {}).find("sample 100"), std::string::npos);
  TiltRecord timeless = still_record(force_at(0.0, 0.0), 0.01, 300, 15);
  timeless.time_s.clear();
  TiltOptions moving;
  moving.base = TiltBase::moving;
  EXPECT_NE(message(timeless, moving).find("needs time"), std::string::npos);
  TiltRecord flat = still_record(force_at(0.0, 0.0), 0.01, 300, 16);
  flat.accel_mps2[1].clear();
  EXPECT_NE(message(flat, moving).find("three axes"), std::string::npos);
  EXPECT_NE(message(still_record(force_at(0.0, 0.0), 0.01, 20, 17), moving).find("50"),
            std::string::npos);
}

TEST(TiltModel, HasTheJacobianOfItsMotion) {
  TiltEpochs epochs{.step_s = {0.0, 0.02},
                    .force_mps2 = {force_at(0.2, 0.1), force_at(0.2, 0.1)},
                    .rate_radps = {{0.3, -0.8, 0.5}, {0.3, -0.8, 0.5}},
                    .rate_at_radps = {{0.3, -0.8, 0.5}, {0.3, -0.8, 0.5}},
                    .resting = {0, 0},
                    .accel_cov_m2ps4 = {Mat<3, 3>::Identity(), Mat<3, 3>::Identity()}};
  const TiltModel model(epochs, {}, {.gyroscope = true, .drive = 1e-3, .accel_time_s = 0.1});
  Mat<9> x;
  x << force_at(0.2, 0.1), 0.3, -0.4, 0.2, 0.02, -0.01, 0.03;
  const Mat<9, 9> F = model.transition(x, 1).F;
  for (int i = 0; i < 9; ++i) {
    const Mat<9> h = 1e-5 * Mat<9>::Unit(i);
    const Mat<9> column =
        (model.transition(x + h, 1).mean - model.transition(x - h, 1).mean) / 2e-5;
    EXPECT_NEAR((F.col(i) - column).norm(), 0.0, 2e-3) << i;
  }
}

// About smoothed states the Jacobian includes the curvature of the great circle, on which iterated
// smoothing depends.
TEST(TiltModel, HasTheJacobianOfAFreeRotation) {
  const TiltEpochs epochs{.step_s = {0.0, 0.02},
                          .force_mps2 = {force_at(0.2, 0.1), force_at(0.2, 0.1)},
                          .rate_radps = {},
                          .rate_at_radps = {},
                          .resting = {0, 0},
                          .accel_cov_m2ps4 = {Mat<3, 3>::Identity(), Mat<3, 3>::Identity()}};
  TiltModel model(epochs, {}, {.gyroscope = false, .drive = 1.0, .accel_time_s = 0.1});
  model.linearise_about_smoothed();
  for (const double speed : {1e-3, 1.0, 20.0}) {  // m/s³: the series for slow rotations, and beyond
    const Mat<3> g = force_at(0.2, 0.1);
    Mat<9> x;
    x << g, 0.3, -0.4, 0.2, speed * Mat<3>(g(1), -g(0), 0.0).normalized();
    const Mat<9, 9> F = model.transition(x, 1).F;
    for (int i = 0; i < 9; ++i) {
      const Mat<9> h = 1e-5 * Mat<9>::Unit(i);
      const Mat<9> column =
          (model.transition(x + h, 1).mean - model.transition(x - h, 1).mean) / 2e-5;
      EXPECT_NEAR((F.col(i) - column).head<3>().norm(), 0.0, 1e-7) << speed << ' ' << i;
      EXPECT_NEAR((F.col(i) - column).tail<3>().norm(), 0.0, 1e-7) << speed << ' ' << i;
      // That of the base's acceleration neglects how its rotation depends on g.
      EXPECT_NEAR((F.col(i) - column).segment<3>(3).norm(), 0.0, 2e-3) << speed << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace proofmass::estimate::tilt_test
