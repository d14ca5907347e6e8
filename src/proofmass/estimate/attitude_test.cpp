#include "proofmass/estimate/attitude.hpp"

#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/attitude_test_support.hpp"

namespace proofmass::estimate::attitude_test {
namespace {

using attitude_test::attitude_error;
using attitude_test::Body;
using attitude_test::Scene;
using attitude_test::scene;
using attitude_test::SensorErrors;

/// Sensors with known figures and no other uncertainty.
AttitudeOptions exact_options() {
  AttitudeOptions options;
  options.gravity_std_mps2 = 0.0;
  options.rate_noise_radps_rthz = 1e-4;
  options.accel_noise_mps2_rthz = 1e-3;
  options.rate_scale_std = options.accel_scale_std = 0.0;
  options.rate_bias_walk_radps_rts = options.accel_bias_walk_mps2_rts = 0.0;
  options.rest_speed_std_mps = 1e-4;
  options.rest_creep_radps_rthz = 0.0;
  options.accel_bias_std_mps2 = 0.0;
  return options;
}

Attitude estimated(const Scene& scene, const AttitudeOptions& options) {
  return estimate_attitude(scene.series, scene.rests, options).value();
}

TEST(Attitude, WithoutNoiseIsTheTruth) {
  const Scene moving = scene({}, {});
  const Attitude attitude = estimated(moving, exact_options());
  EXPECT_TRUE(attitude.converged);
  for (std::size_t k = 0; k < moving.truth.R.size(); k += 10) {
    EXPECT_LT(attitude_error(moving, attitude, k).norm(), 1e-5) << k;
    EXPECT_NEAR(attitude.velocity_mps[k].norm(), moving.truth.v[k].norm(), 2e-4) << k;
  }
}

TEST(Attitude, FindsTheBiasesOfBothSensors) {
  SensorErrors errors;
  errors.rate_bias = {0.01, -0.02, 0.015};
  errors.accel_bias = {0.03, -0.05, 0.04};
  Body body;
  body.moves = 6;
  body.turn_rad = {1.3, -0.9, 0.7};
  const Scene moving = scene(body, errors);
  AttitudeOptions options = exact_options();
  options.accel_bias_std_mps2 = 0.1;
  const Attitude attitude = estimated(moving, options);
  EXPECT_TRUE(attitude.rate_bias_radps.back().isApprox(errors.rate_bias, 1e-4));
  EXPECT_TRUE(attitude.accel_bias_mps2.back().isApprox(errors.accel_bias, 1e-3));
  EXPECT_LT(attitude.accel_bias_std_mps2.back().maxCoeff(), 0.01);
}

TEST(Attitude, AtOneRestTheBiasAcrossGravityIsNotSeparableFromTilt) {
  Body body;
  body.moves = 0;
  body.start.setZero();
  AttitudeOptions options = exact_options();
  options.accel_bias_std_mps2 = 0.1;
  const Attitude attitude = estimated(scene(body, {}), options);
  const Mat<3> std = attitude.accel_bias_std_mps2.back();
  EXPECT_NEAR(std.x(), 0.1, 1e-3);
  EXPECT_NEAR(std.y(), 0.1, 1e-3);
  EXPECT_LT(std.z(), 1e-2);
  EXPECT_NEAR(inclination_std_rad(attitude.attitude_cov_rad2.back()), 0.1 / standard_gravity_mps2,
              1e-4);
}

TEST(Attitude, HeadingStartsAtZeroIsNeverReadAndItsVarianceGrows) {
  const Scene moving = scene({}, {});
  const Attitude attitude = estimated(moving, exact_options());
  const Mat<3, 3> R = rotation_of(attitude.quaternion.front());
  EXPECT_NEAR(R(1, 0), 0.0, 1e-6);
  EXPECT_GT(R(0, 0), 0.0);
  EXPECT_NEAR(attitude.attitude_cov_rad2.front()[5], 0.0, 1e-15);
  for (std::size_t k = 1; k < attitude.attitude_cov_rad2.size(); ++k)
    EXPECT_GE(attitude.attitude_cov_rad2[k][5], attitude.attitude_cov_rad2[k - 1][5] - 1e-14);
  ASSERT_FALSE(attitude.notes.empty());
  EXPECT_NE(attitude.notes.front().text.find("heading is not observable"), std::string::npos);
}

TEST(Attitude, ASensorOnItsSideStartsWithItsYAxisAhead) {
  Body body;
  body.moves = 0;
  body.start = {0.0, -std::numbers::pi / 2.0, 0.0};  // x upward
  const Attitude attitude = estimated(scene(body, {}), exact_options());
  const Mat<3, 3> R = rotation_of(attitude.quaternion.front());
  EXPECT_NEAR(R(2, 0), 1.0, 1e-6);
  EXPECT_NEAR(R(1, 1), 1.0, 1e-6);
}

TEST(Attitude, ARestInWhichTheGyroscopeTurnsIsNotUsed) {
  Body body;
  body.moves = 0;
  body.rest_s = 20.0;
  body.start.setZero();
  Scene turntable = scene(body, {});
  for (std::size_t k = 1000; k < 2000; ++k) turntable.series.rate_radps[2][k] = 0.2;
  turntable.rests = {{0, 900}, {1001, 1999}};
  const Attitude attitude = estimated(turntable, exact_options());
  ASSERT_EQ(attitude.rests.size(), 2u);
  EXPECT_TRUE(attitude.rests[0].used);
  EXPECT_FALSE(attitude.rests[1].used);
  EXPECT_NE(attitude.rests[1].why_not.find("turns"), std::string::npos);
  const Mat<3> turned = rotation_vector(rotation_of(attitude.quaternion.back()));
  EXPECT_NEAR(turned.z(), 2.0, 0.01);
}

TEST(Attitude, WithoutRestsTheVelocityBoundKeepsTheVerticalUpright) {
  SensorErrors errors;
  errors.rate_bias = {0.01, -0.01, 0.0};
  errors.rate_noise = 1e-4;
  Body body;
  body.moves = 12;
  Scene moving = scene(body, errors);
  moving.rests.clear();
  AttitudeOptions options = exact_options();
  options.speed_std_mps = 0.3;
  const Attitude attitude = estimated(moving, options);
  const std::size_t middle = moving.truth.R.size() / 2;
  const Mat<3> error = attitude_error(moving, attitude, middle);
  EXPECT_LT(error.head<2>().norm(), 0.03);
  EXPECT_LT(error.head<2>().norm(), 4.0 * inclination_std_rad(attitude.attitude_cov_rad2[middle]));
  EXPECT_EQ(attitude.notes[1].severity, Severity::warning);
}

TEST(Attitude, MissingReadingsAreBridgedAndDoubted) {
  Scene moving = scene({}, {});
  const Attitude whole = estimated(moving, exact_options());
  for (std::size_t k = 300; k < 320; ++k)
    moving.series.rate_radps[1][k] = std::numeric_limits<double>::quiet_NaN();
  moving.series.accel_mps2[0][50] = std::numeric_limits<double>::infinity();
  const Attitude attitude = estimated(moving, exact_options());
  EXPECT_EQ(attitude.interpolated, 21u);
  EXPECT_EQ(attitude.stretches.size(), 1u);
  const auto heading_variance = [](const Attitude& a) { return a.attitude_cov_rad2[320][5]; };
  EXPECT_GT(heading_variance(attitude), 10.0 * heading_variance(whole));
  const Mat<3> error = attitude_error(moving, attitude, 320);
  EXPECT_LT(std::abs(error.z()), 3.0 * std::sqrt(heading_variance(attitude)));
}

TEST(Attitude, AGapBeginsANewStretch) {
  Scene moving = scene({}, {});
  for (std::size_t k = 250; k < 400; ++k)
    moving.series.accel_mps2[2][k] = std::numeric_limits<double>::quiet_NaN();
  const Attitude attitude = estimated(moving, exact_options());
  ASSERT_EQ(attitude.stretches.size(), 2u);
  EXPECT_EQ(attitude.stretches[0].last, 249u);
  EXPECT_EQ(attitude.stretches[1].first, 400u);
  EXPECT_TRUE(std::isnan(attitude.quaternion[300][0]));
  EXPECT_LT(attitude.position_m[400].norm(), 1e-3);
  EXPECT_LT(attitude_error(moving, attitude, 1199).head<2>().norm(), 1e-4);
}

TEST(Attitude, GravityFreeAccelerationIsThatOfTheBody) {
  Body body;
  body.start = {0.2, 0.0, 0.0};  // x horizontal, so that the heading of both is 0
  const Scene moving = scene(body, {});
  const Attitude attitude = estimated(moving, exact_options());
  const auto accel = gravity_free_acceleration(moving.series, attitude);
  for (std::size_t k = 0; k < moving.truth.accel.size(); k += 7)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(accel[i][k], moving.truth.accel[k](static_cast<int>(i)), 1e-4) << k;
}

TEST(Attitude, TakesTheNoiseFromTheRests) {
  SensorErrors errors;
  errors.rate_noise = 3e-4;
  errors.accel_noise = 2e-3;
  Body body;
  body.rest_s = 10.0;
  AttitudeOptions options = exact_options();
  options.rate_noise_radps_rthz.reset();
  options.accel_noise_mps2_rthz.reset();
  const Attitude attitude = estimated(scene(body, errors), options);
  EXPECT_NEAR(attitude.rate_noise_radps_rthz, errors.rate_noise, 0.15 * errors.rate_noise);
  EXPECT_NEAR(attitude.accel_noise_mps2_rthz, errors.accel_noise, 0.15 * errors.accel_noise);
}

TEST(Attitude, SaysWhyItCannot) {
  Scene moving = scene({}, {});
  const auto code = [&](const InertialSeries& series, const std::vector<signal::Rest>& rests) {
    return estimate_attitude(series, rests, {}).error().code;
  };
  InertialSeries short_axis = moving.series;
  short_axis.accel_mps2[1].pop_back();
  EXPECT_EQ(code(short_axis, {}), Errc::invalid_argument);
  InertialSeries back_in_time = moving.series;
  back_in_time.time_s[5] = back_in_time.time_s[4];
  EXPECT_EQ(code(back_in_time, {}), Errc::invalid_argument);
  EXPECT_EQ(code(moving.series, {{0, 100000}}), Errc::invalid_argument);
  EXPECT_EQ(code(moving.series, {{0, 100}, {100, 200}}), Errc::invalid_argument);
  EXPECT_EQ(code({}, {}), Errc::too_few_samples);
  InertialSeries nothing = moving.series;
  for (double& x : nothing.rate_radps[0]) x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(nothing, {}), Errc::too_few_samples);
}

/// Runs with biases and noise drawn according to the options.
TEST(Attitude, ErrorsAreAsLargeAsTheirCovariance) {
  constexpr int runs = 40;
  AttitudeOptions options = exact_options();
  options.rate_noise_radps_rthz = 5e-4;
  options.accel_noise_mps2_rthz = 3e-3;
  options.rate_bias_std_radps = 0.02;
  options.accel_bias_std_mps2 = 0.05;
  options.rest_speed_std_mps = 1e-3;
  Body body;
  body.rate_hz = 25.0;
  double tilt = 0.0, heading = 0.0, position = 0.0;
  for (int run = 0; run < runs; ++run) {
    Random random(7, "biases", static_cast<std::size_t>(run));
    SensorErrors errors;
    for (int i = 0; i < 3; ++i) {
      errors.rate_bias(i) = 0.02 * random.normal();
      errors.accel_bias(i) = 0.05 * random.normal();
    }
    errors.rate_noise = *options.rate_noise_radps_rthz;
    errors.accel_noise = *options.accel_noise_mps2_rthz;
    errors.seed = static_cast<std::uint64_t>(run) + 1;
    const Scene moving = scene(body, errors);
    const Attitude attitude = estimated(moving, options);
    const std::size_t last = moving.truth.R.size() - 1;
    const Mat<3> error = attitude_error(moving, attitude, last);
    const Symmetric3& cov = attitude.attitude_cov_rad2[last];
    Mat<2, 2> P;
    P << cov[0], cov[1], cov[1], cov[3];
    tilt += error.head<2>().dot(positive_inverse(P) * error.head<2>());
    heading += error.z() * error.z() / cov[5];
    const double off = attitude.position_m[last].z() - moving.truth.p[last].z();
    position += off * off / attitude.position_cov_m2[last][5];
  }
  const auto within = [](double sum, int degrees) {
    const double n = runs * degrees;
    return sum > chi_square_quantile(5e-4, n) && sum < chi_square_quantile(1.0 - 5e-4, n);
  };
  EXPECT_TRUE(within(tilt, 2)) << tilt / runs;
  EXPECT_TRUE(within(heading, 1)) << heading / runs;
  EXPECT_TRUE(within(position, 1)) << position / runs;
}

}  // namespace
}  // namespace proofmass::estimate::attitude_test
