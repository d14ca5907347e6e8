#include <gtest/gtest.h>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/attitude_test_support.hpp"

namespace proofmass::estimate::attitude_slow_test {
namespace {

using namespace attitude_test;

// Biases and noise are drawn according to the options; tested at the last rest, and for the
// smoother also in the middle of a move.
TEST(AttitudeMonteCarlo, NinetyFivePercentBandsHoldTheTruthInNinetyThreeToNinetySevenPercent) {
  constexpr int runs = 600;
  AttitudeOptions options;
  options.gravity_std_mps2 = 0.0;
  options.rate_noise_radps_rthz = 5e-4;
  options.accel_noise_mps2_rthz = 3e-3;
  options.rate_scale_std = options.accel_scale_std = 0.0;
  options.rate_bias_std_radps = 0.02;
  options.accel_bias_std_mps2 = 0.05;
  options.rate_bias_walk_radps_rts = options.accel_bias_walk_mps2_rts = 0.0;
  options.rest_speed_std_mps = 1e-3;
  options.rest_creep_radps_rthz = 0.0;
  Body body;
  body.rate_hz = 25.0;
  int inside = 0, count = 0;
  double tilt_nees = 0.0;
  for (int run = 0; run < runs; ++run) {
    Random random(11, "biases", static_cast<std::size_t>(run));
    SensorErrors errors;
    for (int i = 0; i < 3; ++i) {
      errors.rate_bias(i) = options.rate_bias_std_radps * random.normal();
      errors.accel_bias(i) = options.accel_bias_std_mps2 * random.normal();
    }
    errors.rate_noise = *options.rate_noise_radps_rthz;
    errors.accel_noise = *options.accel_noise_mps2_rthz;
    errors.seed = static_cast<std::uint64_t>(run) + 1000;
    const Scene moving = scene(body, errors);
    const Attitude attitude = estimate_attitude(moving.series, moving.rests, options).value();
    const auto judge = [&](double error, double variance) {
      ++count;
      if (error * error < 3.841459 * variance) ++inside;
    };
    const std::size_t last = moving.truth.R.size() - 1;
    for (const std::size_t k : {std::size_t{90}, last}) {
      const Mat<3> error = attitude_error(moving, attitude, k);
      const Symmetric3& cov = attitude.attitude_cov_rad2[k];
      judge(error.x(), cov[0]);
      judge(error.y(), cov[3]);
      judge(error.z(), cov[5]);
      judge(attitude.position_m[k].z() - moving.truth.p[k].z(), attitude.position_cov_m2[k][5]);
      judge(attitude.velocity_mps[k].z() - moving.truth.v[k].z(),
            attitude.velocity_cov_m2ps2[k][5] + 1e-12);
    }
    const Mat<3> error = attitude_error(moving, attitude, last);
    const Symmetric3& cov = attitude.attitude_cov_rad2[last];
    Mat<2, 2> P;
    P << cov[0], cov[1], cov[1], cov[3];
    tilt_nees += error.head<2>().dot(positive_inverse(P) * error.head<2>());
  }
  const double share = static_cast<double>(inside) / count;
  RecordProperty("share", std::to_string(share));
  RecordProperty("tilt_nees", std::to_string(tilt_nees / runs));
  EXPECT_GT(share, 0.93) << tilt_nees / runs;
  EXPECT_LT(share, 0.97) << tilt_nees / runs;
  EXPECT_GT(tilt_nees, chi_square_quantile(0.025, 2.0 * runs));
  EXPECT_LT(tilt_nees, chi_square_quantile(0.975, 2.0 * runs));
}

}  // namespace
}  // namespace proofmass::estimate::attitude_slow_test
