#include "proofmass/thesis/thesis_paths.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/gain_study.hpp"
#include "proofmass/estimate/models/fusion_model.hpp"
#include "proofmass/thesis/wheel/rig.hpp"

namespace proofmass::thesis::thesis_paths_test {
namespace {

std::vector<double> even_times(std::size_t count, double step_s) {
  std::vector<double> time_s(count);
  for (std::size_t k = 0; k < count; ++k) time_s[k] = static_cast<double>(k) * step_s;
  return time_s;
}

FusedReading noisy_reading(std::size_t count, std::uint64_t seed) {
  FusedReading reading{.time_s = even_times(count, 0.005),
                       .accel_mps2 = {},
                       .variance_m2ps4 = 1e-4,
                       .bias_mps2 = {0.2, 0.02},
                       .bias_rise_mps2 = 0.25};
  Random random(seed, "readings");
  for (const double t_s : reading.time_s)
    reading.accel_mps2.push_back(0.2 + 0.3 * std::sin(2.0 * t_s) + 0.01 * random.normal());
  return reading;
}

TEST(IntegratedTwice, OfGravityThatTurnsIsTheClosedForm) {
  const TurningGravity gravity{
      .gravity_mps2 = 9.81, .speed_radps = 11.0 * radps_per_rpm, .phase_rad = 0.7};
  const std::vector<double> time_s = even_times(1091, 0.005);
  std::vector<double> accel;
  for (const double t_s : time_s)
    accel.push_back(9.81 * std::cos(gravity.speed_radps * t_s + gravity.phase_rad));
  const std::vector<double> path = integrated_twice(time_s, accel, 0.0);
  for (const std::size_t k : {100U, 400U, 1090U})
    EXPECT_NEAR(path[k], gravity_path_m(gravity, time_s[k]), 2e-4) << k;
}

TEST(IntegratedTwice, OfAConstantWithASpeedIsTheParabolaThoughReadingsAreMissing) {
  std::vector<double> accel(101, 2.0);
  accel[40] = accel[41] = std::nan("");
  const std::vector<double> time_s = even_times(101, 0.01);
  EXPECT_NEAR(integrated_twice(time_s, accel, 3.0).back(), 3.0 + 1.0, 1e-12);
}

// At 11 rpm, uncompensated gravity gives metres within 2 s for nearly every start angle, a bias of
// table 5.1 0.4 m: only gravity explains the errors printed in the thesis.
TEST(GravityPath, IsOfTheSizeOfTheErrorsThatTheThesisPrints) {
  double squares = 0.0;
  for (int k = 0; k < 360; ++k)
    squares += std::pow(gravity_path_m({.gravity_mps2 = standard_gravity_mps2,
                                        .speed_radps = 11.0 * radps_per_rpm,
                                        .phase_rad = k * rad_per_deg},
                                       2.0),
                        2);
  EXPECT_NEAR(std::sqrt(squares / 360.0), 11.9, 0.2);
  EXPECT_LT(0.5 * 22.29e-3 * standard_gravity_mps2 * 4.0, 0.45);
}

// Independent computation: all states at once by weighted least squares.
TEST(ThesisPaths, SmootherEqualsOneLeastSquaresProblem) {
  constexpr int count = 30;
  const FusedReading reading = noisy_reading(count, 3);
  const auto model = estimate::pva_bias_model(
      {.motion = {.dt_s = 0.005, .jerk_psd_m2ps5 = 1.0, .accel_variance_m2ps4 = 1e-4},
       .time_constant_s = reading.time_constant_s,
       .bias_psd_m2ps5 = 0.0});
  // Unknowns: deviation of the initial state (p, v known; a, ε unknown) and the contribution of
  // white jerk to each step.
  constexpr int jerks = 3 * (count - 1), unknowns = 2 + jerks;
  Eigen::MatrixXd states = Eigen::MatrixXd::Zero(4, unknowns + 1);  // last column: known part
  states(2, 0) = states(3, 1) = 1.0;
  states(3, unknowns) = 0.2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  normal(0, 0) += 1.0 / 100.0;
  normal(1, 1) += 1.0 / (0.02 * 0.02);
  const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(model.Q.topLeftCorner<3, 3>()).matrixL();
  for (int k = 0; k < count; ++k) {
    if (k > 0) {
      states = (model.F * states).eval();
      states.block<3, 3>(0, 2 + 3 * (k - 1)) += root;
      states(3, unknowns) += model.B(3, 0) * 0.45;
      normal.block<3, 3>(2 + 3 * (k - 1), 2 + 3 * (k - 1)) += Eigen::Matrix3d::Identity();
    }
    const Eigen::RowVectorXd h = model.H * states;
    const double off = reading.accel_mps2[static_cast<std::size_t>(k)] - h(unknowns);
    normal += h.head(unknowns).transpose() * h.head(unknowns) / 1e-4;
    right += h.head(unknowns).transpose() * off / 1e-4;
  }
  const Eigen::VectorXd solved = normal.ldlt().solve(right);
  const Eigen::Vector4d last = states.leftCols(unknowns) * solved + states.col(unknowns);
  const ThesisPaths paths = thesis_paths(reading).value();
  EXPECT_NEAR(paths.smoothed_m.back(), last(0), 1e-7);
  EXPECT_NEAR(paths.smoothed_accel_mps2.back(), last(2), 1e-5);
}

TEST(ThesisPaths, GainSettlesAtTheClosedFormOfItsModel) {
  const ThesisPaths paths = thesis_paths(noisy_reading(600, 5)).value();
  const auto limit = estimate::gain_study({.accel_variance_m2ps4 = 1e-4, .step_s = 0.005}).limit;
  // The unknown part of the bias is negligible: (0.02 m/s²)² against 1e-4.
  EXPECT_NEAR(paths.gain.back(), limit[2], 2e-5);
  EXPECT_GT(paths.gain.front(), 0.999);
}

TEST(ThesisPaths, SmootherEqualsTheFilterAtTheEnd) {
  const ThesisPaths paths = thesis_paths(noisy_reading(400, 9)).value();
  EXPECT_DOUBLE_EQ(paths.smoothed_m.back(), paths.filtered_m.back());
  EXPECT_DOUBLE_EQ(paths.smoothed_std_m.back(), paths.filtered_std_m.back());
}

// Appendix A.1 with four rows: its mean of y1 and y2 is the path from the fused measurement.
TEST(FourteenStates, HoldTheFusedPairOfOneAxis) {
  RigRun run;
  const WheelRecord record = simulate_wheel(run).value();
  const double variance = std::pow(rig_noise_mps2(), 2);
  FusedReading fused{.time_s = record.sensors[0].time_s,
                     .accel_mps2 = {},
                     .variance_m2ps4 = variance / 2.0,
                     .bias_mps2 = {0.1, 0.02}};
  std::vector<estimate::Epoch<4, 2>> epochs(300);
  fused.time_s.resize(epochs.size());
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    if (k > 0) epochs[k].dt_s = 0.005;
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t axis = 0; axis < 2; ++axis)
        epochs[k].z(static_cast<int>(2 * s + axis)) = record.sensors[s].accel_mps2[axis][k];
    epochs[k].u.setConstant(0.1);
    fused.accel_mps2.push_back(0.5 * (epochs[k].z(1) + epochs[k].z(3)));
  }
  // The mean of two motions of density 2 has density 1.
  auto series = estimate::LinearSeries<14, 4, 2>::make(std::move(epochs), [&](double dt_s) {
    estimate::FusionModelOptions options;
    options.axes.fill({.dt_s = dt_s, .jerk_psd_m2ps5 = 2.0, .accel_variance_m2ps4 = variance});
    options.bias_x =
        options.bias_y = {.dt_s = dt_s, .time_constant_s = 70.0, .bias_psd_m2ps5 = 0.0};
    return estimate::fusion_model(options);
  });
  estimate::Gaussian<14> start;
  start.mean.tail<2>().setConstant(0.1);
  for (int axis = 0; axis < 4; ++axis) {
    start.cov(3 * axis, 3 * axis) = 2e-12;
    start.cov(3 * axis + 2, 3 * axis + 2) = 200.0;
  }
  start.cov(12, 12) = start.cov(13, 13) = 0.02 * 0.02;
  const auto all = estimate::filter_linear(std::move(series).value(), start, {});
  const auto& last = all.steps.back().filtered.mean;
  const ThesisPaths paths = thesis_paths(fused).value();
  EXPECT_NEAR(0.5 * (last(3) + last(9)), paths.filtered_m.back(), 1e-6);
}

}  // namespace
}  // namespace proofmass::thesis::thesis_paths_test
