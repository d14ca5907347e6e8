#include "proofmass/estimate/motion_models.hpp"

#include <gtest/gtest.h>

namespace proofmass::estimate::motion_models_test {
namespace {

const PvaOptions options{.dt_s = 0.1, .jerk_psd_m2ps5 = 0.3, .accel_variance_m2ps4 = 0.04};
const PvaBiasOptions bias_options{
    .motion = options, .time_constant_s = 20.0, .bias_psd_m2ps5 = 0.02};

PvaOptions of_length(double dt_s) {
  PvaOptions other = options;
  other.dt_s = dt_s;
  return other;
}

PvaBiasOptions bias_of_length(double dt_s) {
  PvaBiasOptions other = bias_options;
  other.motion.dt_s = dt_s;
  return other;
}

TEST(Pva, TwoStepsEqualOneOfTwiceTheLength) {
  const LinearModel one = pva_model(options), two = pva_model(of_length(0.2));
  EXPECT_TRUE(two.F.isApprox(one.F * one.F, 1e-14));
  EXPECT_TRUE(two.Q.isApprox(one.F * one.Q * one.F.transpose() + one.Q, 1e-14));
}

TEST(Pva, AStepOfZeroDurationChangesNothing) {
  const LinearModel none = pva_model(of_length(0.0));
  EXPECT_EQ(none.F, (Mat<3, 3>::Identity()));
  EXPECT_EQ(none.Q, (Mat<3, 3>::Zero()));
}

TEST(Pva, TakesItsNoiseFromTheOptions) {
  const LinearModel model = pva_model(options);
  EXPECT_DOUBLE_EQ(model.Q(pva::accel_mps2, pva::accel_mps2),
                   options.jerk_psd_m2ps5 * options.dt_s);
  EXPECT_DOUBLE_EQ(model.R.value(), options.accel_variance_m2ps4);
}

TEST(Pva, AccelerometerReadsTheAcceleration) {
  EXPECT_EQ((pva_model(options).H * Mat<3>(1.0, 2.0, 3.0)).value(), 3.0);
}

TEST(PvaBias, TwoStepsEqualOneOfTwiceTheLength) {
  const LinearModel one = pva_bias_model(bias_options), two = pva_bias_model(bias_of_length(0.2));
  EXPECT_TRUE(two.F.isApprox(one.F * one.F, 1e-14));
  EXPECT_TRUE(two.Q.isApprox(one.F * one.Q * one.F.transpose() + one.Q, 1e-14));
  EXPECT_TRUE(two.B.isApprox(one.F * one.B + one.B, 1e-14));
}

TEST(PvaBias, AccelerometerReadsTheAccelerationAndTheBias) {
  const LinearModel model = pva_bias_model(bias_options);
  EXPECT_EQ((model.H * Mat<4>(1.0, 2.0, 3.0, 0.5)).value(), 3.5);
  EXPECT_DOUBLE_EQ(model.R.value(), options.accel_variance_m2ps4);
}

TEST(PvaBias, WithoutNoiseTheBiasIsTheFittedWarmUp) {
  constexpr double a1 = 0.1, a2 = -0.03, T = 20.0;
  Mat<4> x(0.0, 0.0, 0.0, a2);
  double t = 0.0;
  for (const double dt_s : {0.005, 0.7, 3.0, 12.0, 40.0}) {
    const LinearModel model = pva_bias_model(bias_of_length(dt_s));
    x = (model.F * x + model.B * (a1 + a2)).eval();
    t += dt_s;
    EXPECT_NEAR(x(pva::bias_mps2), a1 * (1.0 - std::exp(-t / T)) + a2, 1e-15) << "t = " << t;
  }
  EXPECT_EQ(x(pva::position_m), 0.0);
}

TEST(PvaBias, AfterManyTimeConstantsTheBiasHasItsStationaryVariance) {
  const LinearModel model = pva_bias_model(bias_of_length(2000.0));
  EXPECT_DOUBLE_EQ(model.Q(pva::bias_mps2, pva::bias_mps2),
                   0.5 * bias_options.bias_psd_m2ps5 * bias_options.time_constant_s);
}

// At rest the acceleration is small a priori, so the accelerometer measures the bias, and the
// filter with the warm-up model ends closer to the truth than the one with a constant bias.
TEST(PvaBias, KnowingTheWarmUpKeepsItOutOfTheAcceleration) {
  constexpr double a1 = 0.1, a2 = -0.03;
  const auto run_with = [&](double settles_at) {
    std::vector<Epoch<1, 1>> epochs(2000, Epoch<1, 1>{0.1, Mat<1>(0.0), Mat<1>(settles_at)});
    for (std::size_t k = 0; k < epochs.size(); ++k)
      epochs[k].z(0) = a1 * (1.0 - std::exp(-0.1 * static_cast<double>(k) / 20.0)) + a2;
    const auto still = [](double dt_s) {
      PvaBiasOptions quiet = bias_of_length(dt_s);
      quiet.motion.jerk_psd_m2ps5 = 1e-6;
      quiet.bias_psd_m2ps5 = 0.0;
      return pva_bias_model(quiet);
    };
    Gaussian<4> prior;
    prior.mean(pva::bias_mps2) = a2;
    prior.cov.diagonal() << 1e-6, 1e-6, 1e-4, 1e-6;
    return filter_linear(LinearSeries<4, 1, 1>::make(epochs, still).value(), prior)
        .steps.back()
        .filtered.mean;
  };
  EXPECT_NEAR(run_with(a1 + a2)(pva::accel_mps2), 0.0, 1e-12);
  EXPECT_NEAR(run_with(a1 + a2)(pva::position_m), 0.0, 1e-8);
  EXPECT_GT(std::abs(run_with(a2)(pva::position_m)), 100.0);
}

}  // namespace
}  // namespace proofmass::estimate::motion_models_test
