#include "proofmass/simulate/rig/sensor_twin.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/core/statistics.hpp"
#include "proofmass/sensor/calibration.hpp"

namespace proofmass::simulate::sensor_twin_test {
namespace {

/// A rig with one error-free sensor.
RigOptions perfect_sensor() {
  RigOptions options;
  options.bias_spread_mps2 = 0.0;
  RigSensor sensor;
  sensor.warm_up_mps2 = {};
  sensor.noise_rms_mps2 = {};
  options.sensors = {sensor};
  return options;
}

double autocorrelation(const std::vector<double>& x, std::size_t lag) {
  double top = 0.0, bottom = 0.0;
  for (std::size_t k = 0; k + lag < x.size(); ++k) top += x[k] * x[k + lag];
  for (const double v : x) bottom += v * v;
  return top / bottom;
}

std::vector<double> noise_of(const RigOptions& options, std::size_t samples) {
  const SensorTwin twin(options, 0);
  AxisTwin axis(twin, options, 0, 0);
  std::vector<double> noise(samples);
  for (double& n : noise) n = axis.next_noise_mps2();
  return noise;
}

TEST(SensorTwin, WithoutErrorsReadsTheForce) {
  const RigOptions options = perfect_sensor();
  const SensorTwin twin(options, 0);
  EXPECT_TRUE(twin.M.isIdentity(0.0));
  EXPECT_TRUE(twin.R_sensor_wheel.isIdentity(0.0));
  EXPECT_EQ(AxisTwin(twin, options, 0, 1).reading_mps2(3.25, twin.warm_up(10.0)), 3.25);
  EXPECT_EQ(twin.alignment_std_rad, 0.0);
}

TEST(SensorTwin, CrossAxisMixesTheSecondIntoTheFirst) {
  RigOptions options = perfect_sensor();
  options.sensors[0].cross_axis = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06};
  options.sensors[0].scale = {1.1, 1.0, 1.0};
  Eigen::Matrix3d expected;
  expected << 1.1, 0.01, 0.02, 0.033, 1.0, 0.04, 0.055, 0.06, 1.0;
  EXPECT_TRUE(SensorTwin(options, 0).M.isApprox(expected, 1e-15));
}

TEST(SensorTwin, NonlinearityIsItsFractionAtFullScaleAndItClipsThere) {
  RigOptions options = perfect_sensor();
  options.sensors[0].nonlinearity = 0.003;
  options.sensors[0].full_scale_mps2 = 30.0;
  const SensorTwin twin(options, 0);
  const AxisTwin axis(twin, options, 0, 0);
  EXPECT_NEAR(axis.reading_mps2(-30.0, 0.0), -30.0 + 0.003 * 30.0, 1e-12);
  EXPECT_NEAR(axis.reading_mps2(15.0, 0.0), 15.0 + 0.003 * 30.0 / 4.0, 1e-12);
  EXPECT_EQ(axis.reading_mps2(31.0, 0.0), 30.0);
  EXPECT_EQ(axis.reading_mps2(-99.0, 0.0), -30.0);
}

TEST(SensorTwin, WarmsUpExponentially) {
  RigOptions options = perfect_sensor();
  options.sensors[0].warm_up_mps2 = {0.1, -0.2, 0.0};
  options.sensors[0].warm_up_time_s = 20.0;
  options.sensors[0].bias_mps2 = {1.0, 2.0, 3.0};
  const SensorTwin twin(options, 0);
  EXPECT_EQ(AxisTwin(twin, options, 0, 0).bias_mps2(twin.warm_up(0.0)), 1.0);
  EXPECT_NEAR(AxisTwin(twin, options, 0, 0).bias_mps2(twin.warm_up(20.0)),
              1.0 + 0.1 * (1.0 - std::exp(-1.0)), 1e-14);
  EXPECT_NEAR(AxisTwin(twin, options, 0, 1).bias_mps2(twin.warm_up(60.0)),
              2.0 - 0.2 * 0.950212931632136, 1e-14);
  EXPECT_EQ(AxisTwin(twin, options, 0, 2).bias_mps2(twin.warm_up(60.0)), 3.0);
}

TEST(SensorTwin, BiasWalksWithTheRootOfTime) {
  RigOptions options = perfect_sensor();
  options.sensors[0].bias_walk_mps2_rts = {0.01, 0.0, 0.0};
  options.rate_hz = 100.0;
  Moments after_1_s;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    options.seed = seed;
    const SensorTwin twin(options, 0);
    AxisTwin axis(twin, options, 0, 0);
    for (int k = 0; k < 100; ++k) axis.step_walk();
    after_1_s.add(axis.bias_mps2(twin.warm_up(1.0)));
  }
  EXPECT_NEAR(after_1_s.std(), 0.01, 5.0 * 0.01 / std::sqrt(2.0 * 2000));
}

TEST(SensorTwin, PlainNoiseIsWhiteAndHasItsRms) {
  RigOptions options = perfect_sensor();
  options.sensors[0].noise_rms_mps2 = {0.0184, 0.0, 0.0};
  const auto noise = noise_of(options, 100000);
  EXPECT_NEAR(moments(noise).std(), 0.0184, 5.0 * 0.0184 / std::sqrt(2e5));
  EXPECT_NEAR(autocorrelation(noise, 1), 0.0, 5.0 / std::sqrt(1e5));
}

// After one pole the autocorrelation is e^(−2π f t), and the rms ND √(π/2 f).
TEST(SensorTwin, FilteredNoiseHasTheFiltersRmsAndMemory) {
  RigOptions options = perfect_sensor();
  options.rate_hz = 1000.0;
  options.sensors[0].noise_density_mps2_rthz = {1.5e-3, 0.0, 0.0};
  options.sensors[0].bandwidth_hz = 50.0;
  const auto noise = noise_of(options, 200000);
  const double rms = 1.5e-3 * std::sqrt(std::numbers::pi / 2.0 * 50.0);
  EXPECT_NEAR(moments(noise).std(), rms, 0.02 * rms);
  for (const std::size_t lag : {1U, 2U, 5U})
    EXPECT_NEAR(autocorrelation(noise, lag),
                std::exp(-rad_per_turn * 50.0 * static_cast<double>(lag) * 1e-3), 0.02)
        << lag;
}

TEST(OnePole, AnswersAStepAndASineAsItsEquationSays) {
  const double tau = 1.0 / (rad_per_turn * 10.0);
  OnePole step(10.0);
  EXPECT_EQ(step.next(0.0, 2.0), 2.0);
  for (int k = 1; k <= 100; ++k) (void)step.next(1e-12 + k * 1e-3, 3.0);
  OnePole sine(10.0);
  double last = 0.0;
  for (int k = 0; k <= 40000; ++k) last = sine.next(k * 1e-4, std::sin(rad_per_turn * k * 1e-3));
  // At its corner: 1/√2 of the amplitude, a delay of an eighth of a period; 4 s are 40 whole
  // periods.
  EXPECT_NEAR(last, std::sin(-std::numbers::pi / 4.0) / std::numbers::sqrt2, 1e-5);
  EXPECT_NEAR(step.next(0.1 + tau, 3.0), 3.0, 1e-2);
  OnePole ramp(10.0);
  (void)ramp.next(0.0, 0.0);
  EXPECT_NEAR(ramp.next(50.0 * tau, 50.0 * tau), 49.0 * tau, 1e-12);  // a ramp is delayed by tau
}

TEST(SensorTwin, DatasheetErrorsStayInsideTheDatasheetAndFillIt) {
  RigOptions options = perfect_sensor();
  options.datasheet_errors = true;
  Moments alignment, cross, scale, nonlinearity;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    options.seed = seed;
    const RigSensor drawn = SensorTwin(options, 0).sensor;
    for (const double a : drawn.misalignment_rad) alignment.add(a / rad_per_deg);
    for (const double c : drawn.cross_axis) cross.add(c);
    for (const double s : drawn.scale) scale.add(s);
    nonlinearity.add(drawn.nonlinearity);
  }
  EXPECT_NEAR(alignment.max, 0.1, 0.002);
  EXPECT_NEAR(alignment.min, -0.1, 0.002);
  EXPECT_NEAR(cross.max, 0.01, 0.0002);
  EXPECT_NEAR(scale.min, 0.9, 0.002);
  EXPECT_NEAR(scale.max, 1.1, 0.002);
  EXPECT_NEAR(nonlinearity.max, 0.003, 0.0001);
  EXPECT_LE(std::max({alignment.max / 0.1, cross.max / 0.01, nonlinearity.max / 0.003}), 1.0);
  EXPECT_NEAR(SensorTwin(options, 0).alignment_std_rad,
              std::hypot(0.01, 0.1 * rad_per_deg) / std::sqrt(3.0), 1e-15);
}

// The calibration corrects everything except a rotation, and the rotation is about as large as
// stated.
TEST(SensorTwin, ItsModelCalibratesItUpToARotation) {
  RigOptions options = perfect_sensor();
  options.sensors[0].cross_axis = {0.01, -0.02, 0.005, 0.01, -0.01, 0.02};
  options.sensors[0].misalignment_rad = {0.002, -0.001, 0.003};
  options.sensors[0].scale = {1.05, 0.97, 1.02};
  const SensorTwin twin(options, 0);
  const auto rows = sensor::correction_matrix(model_of(twin, options, 0).calibration);
  Eigen::Matrix3d correction;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      correction(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::Matrix3d left = correction * twin.M;
  EXPECT_TRUE((left * left.transpose()).isIdentity(1e-12));
  EXPECT_GT(left.determinant(), 0.0);
  EXPECT_NEAR(std::acos((left.trace() - 1.0) / 2.0), twin.alignment_std_rad, 1e-9);
}

TEST(SensorTwin, WithoutCrossAxisNoRotationIsLeft) {
  RigOptions options = perfect_sensor();
  options.sensors[0].misalignment_rad = {0.002, -0.001, 0.003};
  options.sensors[0].scale = {1.05, 0.97, 1.02};
  options.sensors[0].bias_mps2 = {0.1, 0.2, 0.3};
  const SensorTwin twin(options, 0);
  const sensor::SensorModel model = model_of(twin, options, 0);
  EXPECT_NEAR(twin.alignment_std_rad, 0.0, 1e-15);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(model.calibration.scale[axis]->si(), twin.sensor.scale[axis], 1e-14);
    EXPECT_NEAR(model.calibration.misalignment[axis]->si(), twin.sensor.misalignment_rad[axis],
                1e-14);
    EXPECT_EQ(model.calibration.bias[axis]->si(), twin.sensor.bias_mps2[axis]);
  }
}

TEST(SensorTwin, IsCalibratedWhenItHasWarmedUp) {
  RigOptions options = perfect_sensor();
  options.sensors[0].bias_mps2 = {0.1, 0.2, 0.3};
  options.sensors[0].warm_up_mps2 = {0.05, -0.02, 0.0};
  options.sensors[0].warm_up_time_s = 20.0;
  const SensorTwin twin(options, 0);
  const sensor::SensorModel model = model_of(twin, options, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisTwin readings(twin, options, 0, axis);
    EXPECT_NEAR(model.calibration.bias[axis]->si(), readings.bias_mps2(twin.warm_up(1e6)), 1e-14);
    EXPECT_EQ(model.drift.a2[axis]->si(), readings.bias_mps2(twin.warm_up(0.0)));
  }
}

TEST(SensorTwin, ItsNoiseFigureIsTheTwoSidedDensityThatTheRecordingShows) {
  RigOptions options = perfect_sensor();
  options.sensors[0].noise_rms_mps2 = {0.02, 0.0, 0.03};
  options.sensors[0].noise_density_mps2_rthz = {0.0, 1.5e-3, 4e-3};
  options.rate_hz = 100.0;
  const auto model = model_of(SensorTwin(options, 0), options, 0);
  EXPECT_DOUBLE_EQ(model.noise.white[0]->si(), 0.002);
  // The filter's corner is at the sample rate: three times the power is aliased into the band.
  const double folded = std::numbers::pi / std::tanh(std::numbers::pi);
  EXPECT_NEAR(model.noise.white[1]->si(), 1.5e-3 * std::sqrt(0.5 * folded), 1e-15);
  EXPECT_NEAR(model.noise.white[2]->si(), std::sqrt(9e-6 + 8e-6 * folded), 1e-15);
}

}  // namespace
}  // namespace proofmass::simulate::sensor_twin_test
