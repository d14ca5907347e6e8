#include "proofmass/estimate/models/angular_model.hpp"

#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/random.hpp"

namespace proofmass::estimate::angular_model_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

AngularOptions options(double dt_s) {
  return {.dt_s = dt_s,
          .jerk_psd_rad2ps5 = 0.5,
          .bias_time_constant_s = 0.0,
          .bias_psd_rad2ps5 = 1e-6,
          .accel_variance_rad2ps4 = 0.04,
          .rate_variance_rad2ps2 = 1e-4,
          .angle_variance_rad2 = 1e-4};
}

TEST(AngularModel, ReadsAccelerationWithBiasRateAndAngle) {
  const LinearModel<4, 3, 1> model = angular_model(options(0.1));
  EXPECT_EQ(Mat<3>(model.H * Mat<4>(1.0, 2.0, 3.0, 0.5)), Mat<3>(3.5, 2.0, 1.0));
  EXPECT_EQ(model.R, Mat<3>(0.04, 1e-4, 1e-4));
}

TEST(AngularModel, TheRateSeparatesBiasAndAcceleration) {
  const auto bias_std = [](bool with_rate) {
    std::vector<Epoch<3, 1>> epochs;
    for (int k = 0; k < 1000; ++k)
      epochs.push_back({0.01, Mat<3>(0.2, with_rate ? 0.0 : nan, nan), Mat<1>(0.0)});
    Gaussian<4> prior;
    prior.cov.setIdentity();
    const auto run = filter_linear(
        LinearSeries<4, 3, 1>::make(epochs, [](double dt) { return angular_model(options(dt)); })
            .value(),
        prior);
    return std::sqrt(run.steps.back().filtered.cov(angular::bias_radps2, angular::bias_radps2));
  };
  EXPECT_LT(bias_std(true), 0.1);
  EXPECT_GT(bias_std(false), 0.7);
}

TEST(AngularAccel, OfTwoOppositeSensorsIsFreeOfGravity) {
  const double g = 9.8, alpha = 1.7, radius = 0.1, psi = 0.4;
  const Uncertain found = angular_accel({.first_mps2 = g * std::cos(psi) + radius * alpha,
                                         .second_mps2 = g * std::cos(psi) - radius * alpha,
                                         .variance_m2ps4 = 0.02 * 0.02,
                                         .radius_m = radius});
  EXPECT_NEAR(found.value, alpha, 1e-13);
  EXPECT_NEAR(found.std, 0.02 / (std::sqrt(2.0) * radius), 1e-15);
}

TEST(TiltRate, FindsTheBiasOfTheGyroscope) {
  const TiltRateOptions tilt{.dt_s = 0.01,
                             .rate_psd_rad2ps = 1e-6,
                             .bias_psd_rad2ps3 = 1e-10,
                             .angle_variance_rad2 = 1e-4};
  Random noise(5, "noise");
  std::vector<Epoch<1, 1>> epochs;
  for (int k = 0; k < 3000; ++k)
    epochs.push_back({0.01, Mat<1>(0.3 + 0.01 * noise.normal()), Mat<1>(0.05)});
  Gaussian<2> prior;
  prior.cov.setIdentity();
  const auto run = smooth_linear(
      LinearSeries<2, 1, 1>::make(epochs, std::vector(epochs.size(), tilt_rate_model(tilt)))
          .value(),
      prior);
  const auto& last = run.steps.back().smoothed;
  EXPECT_NEAR(last.mean(0), 0.3, 4.0 * std::sqrt(last.cov(0, 0)));
  EXPECT_NEAR(last.mean(1), 0.05, 4.0 * std::sqrt(last.cov(1, 1)));
  EXPECT_LT(std::sqrt(last.cov(1, 1)), 0.001);
}

}  // namespace
}  // namespace proofmass::estimate::angular_model_test
