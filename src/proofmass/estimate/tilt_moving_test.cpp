#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/tilt_test_support.hpp"

// A base that moves, with and without a gyroscope.
namespace proofmass::estimate::tilt_test {
namespace {

double rms_error_rad(const std::vector<double>& angle, const std::vector<double>& truth) {
  double squares = 0.0;
  for (std::size_t k = 100; k < truth.size(); ++k)
    squares += (angle[k] - truth[k]) * (angle[k] - truth[k]);
  return std::sqrt(squares / static_cast<double>(truth.size() - 100));
}

TEST(MovingTilt, FollowsAMovingBaseWithAGyroscopeBetterThanTheForceDoes) {
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

TEST(MovingTilt, FollowsAMovingBaseWithoutAGyroscope) {
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
TEST(MovingTilt, WithoutAGyroscopeTheBandHoldsWhatALevelAccelerationHides) {
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
TEST(MovingTilt, WithoutAGyroscopeARotationIsNotTakenForAnAcceleration) {
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

// A mean of the force over 2 s follows a slow acceleration, which was then taken for tilt: 65 % of
// these angles were inside. Over 10 s an uncertain bias of the gyroscope looks like one, and made
// rotations alone half as precise.
TEST(MovingTilt, WithAGyroscopeASlowAccelerationIsNeitherTiltNorSeenInARotation) {
  const auto turned = [](double accel_mps2, double vibration_mps2, std::uint64_t seed) {
    return swung({.name = "turning",
                  .turning_rad = 0.3,
                  .accel_mps2 = accel_mps2,
                  .vibration_mps2 = vibration_mps2,
                  .gyroscope = true},
                 seed);
  };
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  Coverage roll;
  for (const std::uint64_t seed : {1U, 5U}) {
    const MovingBase swayed = turned(1.0, 0.3, seed);
    const TiltSeries series = estimate_tilt(swayed.record, options).value().series;
    for (std::size_t k = 100; k < 5900; k += 200)
      roll.add(series.roll_rad[k], series.roll_std_rad[k], swayed.roll_rad[k]);
    const MovingBase only_turned = turned(0.0, 0.1, seed);
    EXPECT_LT(*median(estimate_tilt(only_turned.record, options).value().series.roll_std_rad),
              0.3 * rad_per_deg)
        << seed;
  }
  EXPECT_GE(roll.share(), 0.93);
}

// The motion begins with zero velocity and acceleration: before it was found, the angle of the rest
// was stated to its accuracy, many standard deviations from the truth.
TEST(MovingTilt, ARestEndsBeforeASlowOnset) {
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
TEST(MovingTilt, TakesNoIntervalWhoseLevelCreepsForARest) {
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

TEST(MovingTilt, SaysWhatTheBandOfAMovingBaseDoesNotHold) {
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(still_record(force_at(0.1, 0.2), 0.02, 400, 17), options);
  ASSERT_TRUE(solution);
  EXPECT_TRUE(std::ranges::any_of(solution->notes, [](const Note& note) {
    return note.severity == Severity::info && note.text.find("longer than 10 s") != note.text.npos;
  }));
}

TEST(MovingTilt, PassesTheUprightAxisWithoutASingularity) {
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

TEST(MovingTilt, KeepsGoingOverRowsWithoutReadings) {
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

TEST(MovingTilt, CountsAReadingThatALoggerRepeatsOnce) {
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
TEST(MovingTilt, LeavesOutWhatNoSensorReads) {
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

// A nod of 0.2° within a rest is hidden in the noise of the force, and was stated to the accuracy
// of the rest.
TEST(MovingTilt, AGyroscopeSeesANodWithinARest) {
  MovingBase base = moving_base(
      {.samples = 3000, .rest_s = 10.0, .rate_noise_radps_rthz = 1e-4, .reading_std_mps2 = 0.02},
      12);
  constexpr double nod_rad = 0.0035, begin_s = 5.0;
  for (std::size_t k = 0; k < base.record.time_s.size(); ++k) {
    const double s = base.record.time_s[k] - begin_s;
    if (s < 0.0 || s > 1.0) continue;
    const double half = std::sin(std::numbers::pi * s), angle = nod_rad * half * half;
    const double rate = nod_rad * std::numbers::pi * std::sin(2.0 * std::numbers::pi * s);
    auto& f = base.record.accel_mps2;
    const double y = f[1][k], z = f[2][k];
    f[1][k] = y + angle * z;
    f[2][k] = z - angle * y;
    base.record.rate_radps[0][k] += rate;
    base.roll_rad[k] += angle;
  }
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  for (std::size_t k = 510; k < 600; k += 5)
    EXPECT_LT(std::abs(solution->series.roll_rad[k] - base.roll_rad[k]),
              5.0 * solution->series.roll_std_rad[k])
        << k;
}

// As of a gyroscope whose range is narrower than its fastest rotations.
TEST(MovingTilt, BridgesMissingRates) {
  MovingBase base = moving_base({.samples = 4000, .rest_s = 1.5}, 11);
  for (auto& axis : base.record.rate_radps) {
    const double limit = 0.6 * std::abs(*std::ranges::max_element(axis));
    for (double& rate : axis)
      if (std::abs(rate) > limit) rate = no_value;
  }
  TiltOptions options = exact;
  options.base = TiltBase::moving;
  const auto solution = estimate_tilt(base.record, options);
  ASSERT_TRUE(solution) << solution.error().message;
  for (std::size_t k = 0; k < base.pitch_rad.size(); k += 10)
    EXPECT_LT(std::abs(solution->series.pitch_rad[k] - base.pitch_rad[k]),
              5.0 * solution->series.pitch_std_rad[k])
        << k;
}

}  // namespace
}  // namespace proofmass::estimate::tilt_test
