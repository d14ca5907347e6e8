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

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const TiltOptions exact{.gravity_mps2 = {9.80665, 1e-6}, .bias_std_mps2 = 0.0};
const TiltOptions uncalibrated{.gravity_mps2 = {9.80665, 1e-6}};

double rms_error_rad(const std::vector<double>& angle, const std::vector<double>& truth) {
  double squares = 0.0;
  for (std::size_t k = 100; k < truth.size(); ++k)
    squares += (angle[k] - truth[k]) * (angle[k] - truth[k]);
  return std::sqrt(squares / static_cast<double>(truth.size() - 100));
}

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

TEST(Tilt, NoiseOfAStepDithersTheRoundingAway) {
  std::vector<double> coarse, dithered;
  Random random(5, "dither");
  for (int k = 0; k < 4000; ++k) {
    coarse.push_back(std::round(0.3 + 0.05 * random.normal()));
    dithered.push_back(std::round(0.3 + 1.0 * random.normal()));
  }
  EXPECT_NEAR(rounding_variance(coarse, 1.0), 1.0 / 12.0, 1e-12);
  EXPECT_LT(rounding_variance(dithered, 1.0), 1e-12);
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

TEST(Tilt, FollowsAMovingBaseWithAGyroscopeBetterThanTheForceDoes) {
  const MovingBase base = moving_base({.rest_s = 1.5}, 7);
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  options.rate_scale_std = 0.0;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_TRUE(solution->motion->gyroscope);
  EXPECT_EQ(solution->rests.size(), 2U);
  std::vector<double> raw;
  for (std::size_t k = 0; k < base.pitch_rad.size(); ++k) {
    const auto& f = base.record.accel_mps2;
    raw.push_back(std::atan2(-f[0][k], std::hypot(f[1][k], f[2][k])));
  }
  const double by_force = rms_error_rad(raw, base.pitch_rad);
  const double filtered = rms_error_rad(solution->series.filtered_pitch_rad, base.pitch_rad);
  const double smoothed = rms_error_rad(solution->series.pitch_rad, base.pitch_rad);
  EXPECT_LT(filtered, 0.2 * by_force);
  EXPECT_LT(smoothed, 0.6 * filtered);
}

TEST(Tilt, FollowsAMovingBaseWithoutAGyroscope) {
  const MovingBase base =
      moving_base({.accel_std_mps2 = 0.2, .angular_accel_radps2_rthz = 0.3, .gyroscope = false}, 8);
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_FALSE(solution->motion->gyroscope);
  EXPECT_LT(rms_error_rad(solution->series.pitch_rad, base.pitch_rad), 0.02);
}

// Horizontal acceleration of 1 m/s² without rotation, an apparent tilt of 5.8°. Its maxima are as
// quiet as rests.
TEST(Tilt, WithoutAGyroscopeTheBandHoldsWhatALevelAccelerationHides) {
  Coverage pitch;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const MovingBase base = moving_base({.samples = 6000,
                                         .rest_s = 3.0,
                                         .accel_std_mps2 = 0.0,
                                         .sway_mps2 = 1.0,
                                         .slowest_sway_hz = 0.1,
                                         .fastest_sway_hz = 0.5,
                                         .turning = 0.0,
                                         .reading_std_mps2 = 0.02,
                                         .gyroscope = false},
                                        seed);
    TiltOptions options = exact;
    options.base = TiltBase::moving;
    const TiltSolution solution = estimate_tilt(base.record, options).value();
    EXPECT_LE(solution.rests.size(), 2U) << seed;
    const TiltSeries& series = solution.series;
    for (std::size_t k = 500; k < 5500; k += 250)
      pitch.add(series.pitch_rad[k], series.pitch_std_rad[k], base.pitch_rad[k]);
  }
  EXPECT_GE(pitch.share(), 0.93);
}

// Vibration hides a rotation by 17° from one-step predictions: the angles were those of no rotation
// in half of the recordings, inside 68 % of the intervals.
TEST(Tilt, WithoutAGyroscopeARotationIsNotTakenForAnAcceleration) {
  Coverage roll;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const MovingBase base =
        swung({.name = "turning", .turning_rad = 0.3, .vibration_mps2 = 1.0}, seed);
    TiltOptions options = exact;
    options.base = TiltBase::moving;
    const TiltSeries series = estimate_tilt(base.record, options).value().series;
    EXPECT_LT(rms_error_rad(series.roll_rad, base.roll_rad), 0.1) << seed;
    for (std::size_t k = 100; k < 5900; k += 200)
      roll.add(series.roll_rad[k], series.roll_std_rad[k], base.roll_rad[k]);
  }
  EXPECT_GE(roll.share(), 0.93);
}

// The motion begins with zero velocity and acceleration: before it was found, the angle of the rest
// was stated to its accuracy, many standard deviations from the truth.
TEST(Tilt, ARestEndsBeforeASlowOnset) {
  constexpr double rest_s = 5.0, onset_s = 2.0, duration_s = 30.0;
  const auto roll_rad = [](double t_s) {
    const double s = std::clamp((std::min(t_s, duration_s - t_s) - rest_s) / onset_s, 0.0, 1.0);
    return 0.2 * s * s * (3.0 - 2.0 * s) * std::cos(0.8 * t_s);
  };
  Random random(1, "slow onset");
  TiltRecord record;
  for (double t_s = 0.0; t_s < duration_s; t_s += 0.01) {
    const Mat<3> force = force_at(roll_rad(t_s), 0.1);
    record.time_s.push_back(t_s);
    for (std::size_t i = 0; i < 3; ++i)
      record.accel_mps2[i].push_back(force(static_cast<Eigen::Index>(i)) + 0.03 * random.normal());
  }
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const TiltSeries series = estimate_tilt(record, options).value().series;
  for (std::size_t k = 0; k < record.time_s.size(); ++k)
    ASSERT_LT(std::abs(series.roll_rad[k] - roll_rad(record.time_s[k])),
              5.0 * series.roll_std_rad[k])
        << record.time_s[k];
}

// After a rest, an acceleration of 0.42 m/s² that changes by a few mg in five seconds.
TEST(Tilt, TakesNoIntervalWhoseLevelCreepsForARest) {
  const auto accel_mps2 = [](double t) {
    if (t < 4.0 || t > 56.0) return 0.0;
    if (t < 5.5) return 0.21 * (1.0 - std::cos(M_PI * (t - 4.0) / 1.5));
    if (t < 11.0) return 0.42 + 0.03 * std::sin(M_PI * (t - 5.5) / 5.5);
    return 0.42 * std::cos(2.0 * M_PI * (t - 11.0) / 20.0);
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    TiltRecord record = still_record(force_at(0.0, 0.0), 0.02, 6000, seed);
    for (std::size_t k = 0; k < record.time_s.size(); ++k)
      record.accel_mps2[0][k] += accel_mps2(record.time_s[k]);
    TiltOptions options = exact;
    options.base = TiltBase::moving;
    const TiltSolution solution = estimate_tilt(record, options).value();
    EXPECT_GE(solution.rests.size(), 1U) << seed;
    for (const TiltRest& rest : solution.rests)
      EXPECT_LT(std::abs(rest.angles.pitch_rad->value), 0.01) << seed;
  }
}

TEST(Tilt, SaysWhatTheBandOfAMovingBaseDoesNotHold) {
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(still_record(force_at(0.1, 0.2), 0.02, 400, 17), options);
  ASSERT_TRUE(solution);
  EXPECT_TRUE(std::ranges::any_of(solution->notes, [](const Note& note) {
    return note.severity == Severity::info && note.text.find("longer than 10 s") != note.text.npos;
  }));
}

TEST(Tilt, PassesTheUprightAxisWithoutASingularity) {
  TiltRecord record;
  for (int k = 0; k < 1000; ++k) {
    const double pitch = 2.0 * std::numbers::pi * k / 1000.0;
    const Mat<3> f = force_at(0.0, pitch);
    record.time_s.push_back(0.01 * k);
    for (std::size_t i = 0; i < 3; ++i) {
      record.accel_mps2[i].push_back(f(static_cast<Eigen::Index>(i)));
      record.rate_radps[i].push_back(i == 1 ? 0.2 * std::numbers::pi : 0.0);
    }
  }
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_NEAR(solution->series.pitch_rad[250], std::numbers::pi / 2, 0.02);
  EXPECT_TRUE(std::isnan(solution->series.roll_rad[250]));
  EXPECT_NEAR(solution->series.pitch_rad[900], -0.1 * 2.0 * std::numbers::pi, 0.02);
}

TEST(Tilt, KeepsGoingOverRowsWithoutReadings) {
  MovingBase base = moving_base({.rest_s = 1.5}, 9);
  for (std::size_t k = 700; k < 760; ++k) base.record.accel_mps2[1][k] = none;
  for (std::size_t k = 900; k < 905; ++k) base.record.rate_radps[0][k] = none;
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_EQ(solution->unusable, 60U);
  for (std::size_t k = 690; k < 920; ++k)
    EXPECT_NEAR(solution->series.pitch_rad[k], base.pitch_rad[k],
                4.0 * solution->series.pitch_std_rad[k])
        << k;
}

TEST(Tilt, CountsAReadingThatALoggerRepeatsOnce) {
  MovingBase base = moving_base({.accel_std_mps2 = 0.2}, 10);
  for (std::size_t k = 0; k < base.record.time_s.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      base.record.accel_mps2[i][k] = base.record.accel_mps2[i][k - k % 4];
      base.record.rate_radps[i][k] = base.record.rate_radps[i][k - k % 4];
    }
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_TRUE(std::ranges::any_of(solution->notes, [](const Note& note) {
    return note.text.find("1500 of 2000 rows repeat") != std::string::npos;
  }));
}

// A single measurement of 1e300 in a recording of a moving base used to end the filter.
TEST(Tilt, LeavesOutWhatNoSensorReads) {
  for (const TiltBase moves : {TiltBase::still, TiltBase::moving}) {
    TiltRecord record = still_record(force_at(0.1, 0.2), 0.02, 400, 17);
    TiltOptions options = exact;
    options.base = moves;
    const auto clean = estimate_tilt(record, options);
    record.accel_mps2[0][150] = 1e300;
    record.accel_mps2[2][151] = -1e12;
    const auto spoilt = estimate_tilt(record, options);
    ASSERT_TRUE(clean && spoilt && spoilt->final.roll_rad && spoilt->final.pitch_rad);
    EXPECT_NEAR(spoilt->final.roll_rad->value, clean->final.roll_rad->value,
                spoilt->final.roll_rad->std);
    EXPECT_TRUE(std::ranges::any_of(spoilt->notes, [](const Note& note) {
      return note.text.starts_with("2 readings are beyond");
    }));
  }
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
