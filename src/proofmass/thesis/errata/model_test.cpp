#include <Eigen/Core>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/estimate/models/angular_model.hpp"
#include "proofmass/estimate/models/fusion_model.hpp"
#include "proofmass/estimate/motion_models.hpp"
#include "proofmass/sensor/datasheet.hpp"
#include "proofmass/sensor/noise_conversions.hpp"
#include "proofmass/sensor/warm_up.hpp"

// docs/errata.md, sections 4.2, 4.3, A.1 and the matrices of 4.4: the models.
namespace proofmass::thesis::errata_model_test {
namespace {

using estimate::Mat;

constexpr double a1 = 0.25, a2 = -0.21, T_s = 70.0;  // table 4.1

estimate::LinearModel<3, 1> pva(double dt_s) {
  return estimate::pva_model({.dt_s = dt_s, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1e-4});
}

/// Position estimate of a motion model after 10 s of measuring 1 m/s², from rest.
double position_after_ten_seconds(const estimate::LinearModel<3, 1>& model) {
  const std::vector<estimate::Epoch<1>> epochs(101, {.dt_s = 0.1, .z = Mat<1>(1.0)});
  estimate::Gaussian<3> at_rest;
  at_rest.cov(2, 2) = 100.0;
  const std::vector models(epochs.size(), model);
  const auto series = estimate::LinearSeries<3, 1>::make(epochs, models).value();
  return estimate::filter_linear(series, at_rest).steps.back().filtered.mean(0);
}

// (4.45): y = [1 0 0] x + v.
TEST(ErrataChapter4, AMeasurementOfTheAccelerationIsNotOneOfThePosition) {
  estimate::LinearModel<3, 1> model = pva(0.1);
  EXPECT_EQ(model.H, (Mat<1, 3>(0.0, 0.0, 1.0)));
  EXPECT_NEAR(position_after_ten_seconds(model), 50.0, 1e-3);
  model.H << 1.0, 0.0, 0.0;
  EXPECT_NEAR(position_after_ten_seconds(model), 1.0, 0.01);
}

// (4.44): "in discrete form", x[k] = [0 1 0; 0 0 1; 0 0 0] x[k−1] + …
TEST(ErrataChapter4, TheMatrixOfADifferentialEquationIsNotATransition) {
  Mat<3, 3> A;
  A << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  const Mat<3, 3> cube = A * A * A;
  EXPECT_TRUE(cube.isZero(0.0));  // after three steps no state has any effect
  constexpr double dt = 0.3;
  const Mat<3, 3> exponential = Mat<3, 3>::Identity() + dt * A + 0.5 * dt * dt * A * A;
  const auto model = estimate::angular_model({.dt_s = dt, .jerk_psd_rad2ps5 = 1.0});
  EXPECT_LT((model.F.topLeftCorner<3, 3>() - exponential).norm(), 1e-14);
  EXPECT_EQ(model.H(estimate::angular::accel_channel, estimate::angular::angle_rad), 0.0);
  EXPECT_EQ(model.H(estimate::angular::accel_channel, estimate::angular::accel_radps2), 1.0);
}

// (4.48), (4.49): σ_a² = W Δt³/6, "increases as a cubic function of time". Compared with white jerk
// in ten thousand steps.
TEST(ErrataChapter4, AnAccelerationOfWhiteJerkSpreadsWithTimeAndNotWithItsCube) {
  constexpr double W = 2.0, t = 3.0, dt = t / 10000.0;
  Mat<3, 3> F, P = Mat<3, 3>::Zero();
  F << 1.0, dt, 0.5 * dt * dt, 0.0, 1.0, dt, 0.0, 0.0, 1.0;
  for (int k = 0; k < 10000; ++k) {
    P = (F * P * F.transpose()).eval();
    P(2, 2) += W * dt;
  }
  const Mat<3, 3> Q =
      estimate::pva_model({.dt_s = t, .jerk_psd_m2ps5 = W, .accel_variance_m2ps4 = 1.0}).Q;
  EXPECT_LT((P - Q).norm(), 1e-3 * Q.norm());  // (4.50) is correct
  EXPECT_NEAR(Q(2, 2), W * t, 1e-12);
  EXPECT_NEAR(Q(0, 2), W * t * t * t / 6.0, 1e-12);  // (4.49) is the covariance of acceleration
                                                     // and position
}

// (4.54), (4.55): φ = T/(T + Δt), input Δt (a1 + a2)/(T + Δt).
TEST(ErrataChapter4, ThePrintedStepOfTheBiasIsOfFirstOrder) {
  const auto printed = [](double dt) { return T_s / (T_s + dt); };
  const auto ours = [](double dt) {
    return estimate::bias_step({.dt_s = dt, .time_constant_s = T_s, .bias_psd_m2ps5 = 0.0}).phi;
  };
  EXPECT_LT(std::abs(printed(0.005) - ours(0.005)), 3e-9);  // negligible at 200 Hz
  EXPECT_NEAR(ours(T_s), std::exp(-1.0), 1e-15);
  EXPECT_EQ(printed(T_s), 0.5);
  EXPECT_NEAR(ours(35.0) * ours(35.0), ours(T_s), 1e-15);
  EXPECT_GT(std::abs(printed(35.0) * printed(35.0) - printed(T_s)), 0.05);
}

double bias_variance_after(const Mat<1, 4>& H, int readings) {
  auto model = estimate::pva_bias_model(
      {.motion = {.dt_s = 1.0, .jerk_psd_m2ps5 = 1e-4, .accel_variance_m2ps4 = 1e-4},
       .time_constant_s = T_s,
       .bias_psd_m2ps5 = 1e-3});
  model.H = H;
  const std::vector<estimate::Epoch<1, 1>> epochs(static_cast<std::size_t>(readings),
                                                  {.dt_s = 1.0, .z = Mat<1>(0.0)});
  estimate::Gaussian<4> prior;
  prior.cov.diagonal() << 0.0, 0.0, 1e-4, 1.0;
  const std::vector models(epochs.size(), model);
  const auto series = estimate::LinearSeries<4, 1, 1>::make(epochs, models).value();
  return estimate::filter_linear(series, prior).steps.back().filtered.cov(3, 3);
}

// (4.56): C = [0 0 1 0]. Without measurements the variance of the bias obeys P ← φ² P + w.
TEST(ErrataChapter4, WithThePrintedRowNoReadingEverTouchesTheBias) {
  const auto step =
      estimate::bias_step({.dt_s = 1.0, .time_constant_s = T_s, .bias_psd_m2ps5 = 1e-3});
  double unread = 1.0;
  for (int k = 1; k < 100; ++k) unread = step.phi * step.phi * unread + step.variance_m2ps4;
  EXPECT_NEAR(bias_variance_after({0, 0, 1, 0}, 100), unread, 1e-12);
  EXPECT_LT(bias_variance_after({0, 0, 1, 1}, 100), 0.5 * unread);
  const auto ours = estimate::pva_bias_model(
      {.motion = {.dt_s = 1.0, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1.0},
       .time_constant_s = T_s,
       .bias_psd_m2ps5 = 0.0});
  EXPECT_EQ(ours.H, (Mat<1, 4>(0, 0, 1, 1)));  // as in (4.61)
}

// (4.60), A.1: the input column, with 1 for the acceleration, times the measured acceleration.
TEST(ErrataChapter4, ThePrintedInputAddsTheReadingAgainAtEveryStep) {
  constexpr double dt = 0.005, measured = 0.1;
  Mat<4, 4> A;
  A << 1, dt, dt * dt / 2, 0, 0, 1, dt, 0, 0, 0, 1, 0, 0, 0, 0, T_s / (T_s + dt);
  const Mat<4> column(0, 0, 1, dt * (a1 + a2) / (T_s + dt));
  Mat<4> printed = Mat<4>::Zero();
  for (int k = 0; k < 200; ++k) printed = (A * printed + column * measured).eval();
  EXPECT_NEAR(printed(2), 200 * measured, 1e-9);  // for a constant 0.1 after one second

  const auto ours =
      estimate::angular_model({.dt_s = dt, .jerk_psd_rad2ps5 = 1.0, .bias_time_constant_s = T_s});
  EXPECT_EQ((Mat<3>(ours.B.topRows<3>())), Mat<3>(Mat<3>::Zero()));
  EXPECT_NEAR(ours.B(3), dt / T_s, 1e-8);  // multiplies a1 + a2, independent of the measurements
}

// (4.62), A.1: W σ_ε² in each step, whatever its length.
TEST(ErrataChapter4, ThePrintedNoiseOfTheBiasDoublesWithTheRate) {
  const auto after_a_second = [](int steps, auto variance_of) {
    const double phi = std::exp(-1.0 / (T_s * steps));
    double variance = 0.0;
    for (int k = 0; k < steps; ++k) variance = phi * phi * variance + variance_of(1.0 / steps);
    return variance;
  };
  const auto printed = [](double) { return 1e-6; };
  const auto ours = [](double dt) {
    return estimate::bias_step({.dt_s = dt, .time_constant_s = T_s, .bias_psd_m2ps5 = 1e-6})
        .variance_m2ps4;
  };
  EXPECT_NEAR(after_a_second(400, printed) / after_a_second(200, printed), 2.0, 1e-3);
  EXPECT_NEAR(after_a_second(400, ours) / after_a_second(200, ours), 1.0, 1e-12);
}

// 4.3: W "was set to one"; A.1: "W= 1rad/sec". As a density of jerk, with the datasheet's noise in
// a bandwidth of 50 Hz, this makes the filter pass the measurements through.
TEST(ErrataChapter4, ADensityOfOneHandsTheReadingsOn) {
  const double rms = sensor::filtered_noise_rms(sensor::adxl335.noise_density_mps2_rthz[0], 50.0);
  const auto study = estimate::gain_study(
      {.jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = rms * rms, .step_s = 0.005});
  EXPECT_GT(study.limit[2], 0.95);
}

// 4.4: "RMS acceleration noise can be calculated by multiplying power spectrum density by
// bandwidth"; 4.1.4: R is "provided by manufacturer in the data sheet as standard deviation".
TEST(ErrataChapter4, TheRmsIsTheRootOfDensitySquaredTimesTheNoiseBandwidth) {
  const double density = sensor::adxl335.noise_density_mps2_rthz[0];
  const double printed = density * density * 50.0;  // (m/s²)², not an acceleration
  const double rms = sensor::filtered_noise_rms(density, 50.0);
  double squares = 0.0;  // of a one-pole filter: rectangle rule on a logarithmic grid up to 10
                         // MHz
  for (double f = 1e-4; f < 1e7; f *= 1.001) squares += 0.001 * f / (1.0 + f * f / 2500.0);
  EXPECT_NEAR(rms, density * std::sqrt(squares), 1e-3 * rms);
  EXPECT_GT(rms, 70.0 * printed);
}

// 5.1.1: "the bias stabilises after few seconds", with T = 70.
TEST(ErrataChapter5, ATimeConstantOfSeventySecondsSettlesInMinutes) {
  const sensor::WarmUp bias{.a1_mps2 = a1, .a2_mps2 = a2, .time_constant_s = T_s};
  const auto share = [&](double t_s) { return (sensor::bias_at(bias, t_s).value - a2) / a1; };
  EXPECT_LT(share(5.0), 0.07);
  EXPECT_NEAR(share(210.0), 0.95, 0.001);
}

// A.1: C = [0 0 1 0 0 1 0 0 1 0 0 1 0 0], A = diag(Φ, Φ, Φ, Φ) with Φ of four states.
TEST(ErrataAppendixA, FourReadingsAreFourRowsAndTheBiasesStandOnce) {
  const estimate::PvaOptions axis{
      .dt_s = 0.005, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1e-4};
  const estimate::BiasOptions bias{.dt_s = 0.005, .time_constant_s = T_s, .bias_psd_m2ps5 = 0.0};
  const auto model =
      estimate::fusion_model({.axes = {axis, axis, axis, axis}, .bias_x = bias, .bias_y = bias});
  Mat<14> state = Mat<14>::Zero();
  state(2) = 1.0;   // x1 forwards
  state(8) = -1.0;  // x2 backwards: a rotating board
  state(estimate::fusion::bias_y_mps2) = 0.5;
  EXPECT_EQ((Mat<4>(model.H * state)), Mat<4>(1.0, 0.5, -1.0, 0.5));
  Eigen::Matrix<double, 1, 14> printed;
  printed << 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0;
  EXPECT_EQ(printed.dot(state), 0.0);  // insensitive to both
  EXPECT_EQ(model.F.rows(), 14);       // four times Φ would be 16
  EXPECT_LT(model.F(12, 12), 1.0);
  EXPECT_EQ(model.F(3, 3), 1.0);  // the printed one treats a position as a bias
}

}  // namespace
}  // namespace proofmass::thesis::errata_model_test
