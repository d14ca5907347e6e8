#include "proofmass/estimate/fusion.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/core/linalg.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/estimate/fusion_model.hpp"

namespace proofmass::estimate::fusion_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Drive {
  std::vector<double> time_s, position, accel;
  std::vector<AxisSensor> sensors;
};

/// A body that swings, read by so many sensors; times are irregular.
Drive drive(std::size_t sensors, std::size_t samples) {
  Drive out;
  Random noise(2010, "noise");
  for (std::size_t i = 0; i < sensors; ++i) {
    AxisSensor sensor;
    sensor.name = "sensor " + std::to_string(i + 1);
    sensor.accel_variance_m2ps4 = 0.04;
    sensor.bias_std_mps2 = 0.05;
    sensor.bias_psd_m2ps5 = 1e-5;
    out.sensors.push_back(sensor);
  }
  double t = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    t += 0.04 + 0.02 * noise.unit();
    out.time_s.push_back(t);
    const double a = std::sin(2.0 * t);
    out.accel.push_back(a);
    for (AxisSensor& sensor : out.sensors) sensor.accel_mps2.push_back(a + 0.2 * noise.normal());
  }
  return out;
}

FusionOptions options() {
  FusionOptions options;
  options.jerk_psd_m2ps5 = 2.0;
  options.position_m = {0.0, 0.1};
  options.velocity_mps = {-0.5, 0.2};
  options.accel_mps2 = {0.0, 1.0};
  options.velocities_mps = {{40, 0.1, 0.02}, {90, -0.2, 0.02}};
  options.positions_m = {{95, 0.4, 0.05}};
  return options;
}

/// Mean and covariance of all states of all instants at once: the joint distribution that prior and
/// steps imply, given every reading with a dense H.
struct Batch {
  Eigen::VectorXd mean;
  Eigen::MatrixXd cov;
};

template <int S>
Batch before_readings(const Drive& drive, const FusionOptions& options) {
  constexpr int N = 3 + S;
  const auto size = static_cast<Eigen::Index>(drive.time_s.size());
  Batch out{Eigen::VectorXd::Zero(N * size), Eigen::MatrixXd::Zero(N * size, N * size)};
  const auto known = [&](int i, const Uncertain& x) {
    out.mean(i) = x.value;
    out.cov(i, i) = x.std * x.std;
  };
  known(0, options.position_m);
  known(1, options.velocity_mps);
  known(2, options.accel_mps2);
  for (int i = 0; i < S; ++i)
    known(3 + i, {0.0, drive.sensors[static_cast<std::size_t>(i)].bias_std_mps2});
  for (Eigen::Index k = 1; k < size; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double dt = drive.time_s[at] - drive.time_s[at - 1];
    Mat<N, N> F = Mat<N, N>::Identity(), Q = Mat<N, N>::Zero();
    const LinearModel<3, 1> motion = pva_model({dt, options.jerk_psd_m2ps5, 1.0});
    F.template topLeftCorner<3, 3>() = motion.F;
    Q.template topLeftCorner<3, 3>() = motion.Q;
    for (int i = 0; i < S; ++i)
      Q(3 + i, 3 + i) = drive.sensors[static_cast<std::size_t>(i)].bias_psd_m2ps5 * dt;
    out.mean.segment(N * k, N) = F * out.mean.segment(N * (k - 1), N);
    out.cov.block(N * k, 0, N, N * k) = F * out.cov.block(N * (k - 1), 0, N, N * k);
    out.cov.block(0, N * k, N * k, N) = out.cov.block(N * k, 0, N, N * k).transpose();
    out.cov.block(N * k, N * k, N, N) =
        F * out.cov.block(N * (k - 1), N * (k - 1), N, N) * F.transpose() + Q;
  }
  return out;
}

template <int S>
Batch batch(const Drive& drive, const FusionOptions& options) {
  constexpr int N = 3 + S;
  Batch out = before_readings<S>(drive, options);
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> values, variances;
  const auto read = [&](std::size_t k, const Mat<N>& h, double z, double variance) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(out.mean.size());
    row.segment(N * static_cast<Eigen::Index>(k), N) = h;
    rows.push_back(row);
    values.push_back(z);
    variances.push_back(variance);
  };
  for (std::size_t k = 0; k < drive.time_s.size(); ++k)
    for (int i = 0; i < S; ++i) {
      const AxisSensor& sensor = drive.sensors[static_cast<std::size_t>(i)];
      if (!std::isnan(sensor.accel_mps2[k]))
        read(k, Mat<N>::Unit(2) + Mat<N>::Unit(3 + i), sensor.accel_mps2[k],
             sensor.accel_variance_m2ps4);
    }
  for (const AxisReading& v : options.velocities_mps)
    read(v.sample, Mat<N>::Unit(1), v.value, v.std * v.std);
  for (const AxisReading& p : options.positions_m)
    read(p.sample, Mat<N>::Unit(0), p.value, p.std * p.std);
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd H(count, out.mean.size());
  for (Eigen::Index i = 0; i < count; ++i) H.row(i) = rows[static_cast<std::size_t>(i)];
  const Eigen::Map<const Eigen::VectorXd> z(values.data(), count), r(variances.data(), count);
  const Eigen::MatrixXd CH = out.cov * H.transpose();
  Eigen::MatrixXd innovation = H * CH;
  innovation.diagonal() += r;
  const Eigen::MatrixXd gain = CH * positive_inverse(innovation);
  out.mean += gain * (z - H * out.mean);
  out.cov -= gain * CH.transpose();
  return out;
}

template <int S>
void expect_batch(const Drive& drive) {
  constexpr int N = 3 + S;
  const FusedMotion fused = fuse_axis(drive.time_s, drive.sensors, options()).value();
  const Batch all = batch<S>(drive, options());
  const AxisMotion& motion = fused.fused.smoothed;
  for (std::size_t k = 0; k < drive.time_s.size(); ++k) {
    const auto at = N * static_cast<Eigen::Index>(k);
    EXPECT_NEAR(motion.position_m[k], all.mean(at), 1e-6 * motion.position_std_m[k]) << k;
    EXPECT_NEAR(motion.velocity_mps[k], all.mean(at + 1), 1e-6 * motion.velocity_std_mps[k]);
    EXPECT_NEAR(motion.accel_mps2[k], all.mean(at + 2), 1e-6 * motion.accel_std_mps2[k]);
    EXPECT_NEAR(motion.position_std_m[k] / std::sqrt(all.cov(at, at)), 1.0, 1e-6) << k;
  }
  const auto last = N * static_cast<Eigen::Index>(drive.time_s.size() - 1);
  for (int i = 0; i < S; ++i) {
    const Uncertain& bias = fused.fused.bias_mps2[static_cast<std::size_t>(i)];
    EXPECT_NEAR(bias.value, all.mean(last + 3 + i), 1e-8);
    EXPECT_NEAR(bias.std, std::sqrt(all.cov(last + 3 + i, last + 3 + i)), 1e-8);
  }
}

TEST(Fusion, OfOneSensorIsBatchLeastSquares) {
  expect_batch<1>(drive(1, 100));
}
TEST(Fusion, OfTwoSensorsIsBatchLeastSquares) {
  expect_batch<2>(drive(2, 100));
}
TEST(Fusion, OfFourSensorsIsBatchLeastSquares) {
  expect_batch<4>(drive(4, 100));
}

TEST(Fusion, WithMissingReadingsIsBatchLeastSquares) {
  Drive holes = drive(3, 100);
  for (std::size_t k = 20; k < 50; ++k) holes.sensors[0].accel_mps2[k] = nan;
  for (std::size_t k = 45; k < 55; ++k) holes.sensors[1].accel_mps2[k] = nan;
  holes.sensors[2].accel_mps2[49] = nan;
  expect_batch<3>(holes);
}

TEST(Fusion, TwoSensorsHalveTheVarianceOfTheNoise) {
  Drive pair = drive(2, 400);
  for (AxisSensor& sensor : pair.sensors) sensor.bias_std_mps2 = sensor.bias_psd_m2ps5 = 0.0;
  FusionOptions still = options();
  still.jerk_psd_m2ps5 = 1e-12;  // the acceleration is one number, of which every reading tells
  still.velocities_mps.clear();
  still.positions_m.clear();
  still.accel_mps2 = {0.0, 1e3};
  const FusedMotion fused = fuse_axis(pair.time_s, pair.sensors, still).value();
  EXPECT_NEAR(fused.accel_gain, 2.0, 1e-5);
  EXPECT_NEAR(fused.fused.smoothed.accel_std_mps2[200] * std::sqrt(800.0), 0.2, 1e-4);
}

TEST(Fusion, TwoEqualSensorsAreOneOfHalfTheVarianceAndTheirMeanReading) {
  Drive pair = drive(2, 100);
  for (AxisSensor& sensor : pair.sensors) sensor.bias_std_mps2 = sensor.bias_psd_m2ps5 = 0.0;
  AxisSensor mean = pair.sensors[0];
  mean.accel_variance_m2ps4 *= 0.5;
  for (std::size_t k = 0; k < mean.accel_mps2.size(); ++k)
    mean.accel_mps2[k] = 0.5 * (mean.accel_mps2[k] + pair.sensors[1].accel_mps2[k]);
  const FusedMotion two = fuse_axis(pair.time_s, pair.sensors, options()).value();
  const FusedMotion one = fuse_axis(pair.time_s, {mean}, options()).value();
  for (std::size_t k = 0; k < pair.time_s.size(); ++k) {
    EXPECT_NEAR(two.fused.smoothed.position_m[k], one.fused.smoothed.position_m[k], 1e-12);
    EXPECT_NEAR(two.fused.filtered.velocity_mps[k], one.fused.filtered.velocity_mps[k], 1e-12);
  }
}

TEST(Fusion, ADeadChannelCostsOnlyItself) {
  Drive pair = drive(2, 100);
  for (double& x : pair.sensors[1].accel_mps2) x = nan;
  const FusedMotion fused = fuse_axis(pair.time_s, pair.sensors, options()).value();
  const AxisMotion& alone = fused.single[0].smoothed;
  for (std::size_t k = 0; k < pair.time_s.size(); ++k) {
    EXPECT_NEAR(fused.fused.smoothed.position_m[k], alone.position_m[k], 1e-12);
    EXPECT_NEAR(fused.fused.smoothed.position_std_m[k], alone.position_std_m[k], 1e-12);
  }
  EXPECT_NEAR(fused.position_gain, 1.0, 1e-10);
  EXPECT_EQ(fused.fused.readings, 103u);
  const double walked = pair.sensors[1].bias_psd_m2ps5 * (pair.time_s[99] - pair.time_s[0]);
  EXPECT_NEAR(fused.fused.bias_mps2[1].std, std::sqrt(0.05 * 0.05 + walked), 1e-12);
}

TEST(Fusion, OneSensorAloneIsTheFusion) {
  const Drive single = drive(1, 50);
  FusionOptions plain = options();
  plain.velocities_mps.clear();
  plain.positions_m.clear();
  const FusedMotion fused = fuse_axis(single.time_s, single.sensors, plain).value();
  ASSERT_EQ(fused.single.size(), 1u);
  EXPECT_EQ(fused.single[0].smoothed.position_m, fused.fused.smoothed.position_m);
  EXPECT_EQ(fused.position_gain, 1.0);
}

TEST(Fusion, SaysWhyItCannot) {
  const Drive pair = drive(2, 100);
  const auto code = [&](const std::vector<double>& time_s, const std::vector<AxisSensor>& sensors,
                        const FusionOptions& with) {
    return fuse_axis(time_s, sensors, with).error().code;
  };
  EXPECT_EQ(code(pair.time_s, {}, options()), Errc::invalid_argument);
  EXPECT_EQ(code(pair.time_s, drive(5, 100).sensors, options()), Errc::invalid_argument);
  EXPECT_EQ(code({0.0, 1.0}, pair.sensors, options()), Errc::invalid_argument);
  EXPECT_EQ(code({0.0}, pair.sensors, options()), Errc::too_few_samples);
  FusionOptions outside = options();
  outside.positions_m[0].sample = 100;
  EXPECT_EQ(code(pair.time_s, pair.sensors, outside), Errc::invalid_argument);
  FusionOptions no_jerk = options();
  no_jerk.jerk_psd_m2ps5 = nan;
  EXPECT_EQ(code(pair.time_s, pair.sensors, no_jerk), Errc::invalid_argument);
  std::vector<AxisSensor> infinite = pair.sensors;
  infinite[1].accel_mps2[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(pair.time_s, infinite, options()), Errc::not_finite);
  std::vector<double> back = pair.time_s;
  back[4] = back[3];
  EXPECT_EQ(code(back, pair.sensors, options()), Errc::invalid_argument);
}

FusionModelOptions fourteen(double dt_s) {
  FusionModelOptions out;
  for (PvaOptions& axis : out.axes) axis = {dt_s, 0.3, 0.04};
  out.bias_x = {dt_s, 5.0, 0.02};
  out.bias_y = {dt_s, 9.0, 0.03};
  return out;
}

TEST(FusionModel, EachRowReadsItsOwnAccelerationAndItsBias) {
  const LinearModel<14, 4, 2> model = fusion_model(fourteen(0.1));
  Mat<14> x = Mat<14>::Zero();
  for (int i = 0; i < 4; ++i) {
    x(3 * i) = 100.0;
    x(3 * i + 1) = 10.0;
    x(3 * i + 2) = i + 1.0;
  }
  x(fusion::bias_x_mps2) = 0.5;
  x(fusion::bias_y_mps2) = 0.25;
  EXPECT_EQ(Mat<4>(model.H * x), Mat<4>(1.5, 2.25, 3.5, 4.25));
}

TEST(FusionModel, OneAxisOfItIsTheModelOfOneAxis) {
  std::vector<Epoch<4, 2>> epochs;
  std::vector<Epoch<1, 1>> alone;
  Random noise(3, "noise");
  for (int k = 0; k < 60; ++k) {
    const double z = noise.normal();
    epochs.push_back({0.1, Mat<4>(z, nan, nan, nan), Mat<2>(0.1, 0.2)});
    alone.push_back({0.1, Mat<1>(z), Mat<1>(0.1)});
  }
  Gaussian<14> prior;
  prior.cov.setIdentity();
  Gaussian<4> prior_alone;
  prior_alone.cov.setIdentity();
  const auto all = smooth_linear(
      LinearSeries<14, 4, 2>::make(epochs, [](double dt) { return fusion_model(fourteen(dt)); })
          .value(),
      prior);
  const auto one = smooth_linear(
      LinearSeries<4, 1, 1>::make(
          alone, [](double dt) { return pva_bias_model({{dt, 0.3, 0.04}, 5.0, 0.02}); })
          .value(),
      prior_alone);
  EXPECT_NEAR(all.log_likelihood, one.log_likelihood, 1e-10);
  for (std::size_t k = 0; k < 60; ++k) {
    const auto& a = all.steps[k].smoothed;
    const auto& b = one.steps[k].smoothed;
    EXPECT_NEAR(a.mean(0), b.mean(0), 1e-11);
    EXPECT_NEAR(a.mean(fusion::bias_x_mps2), b.mean(3), 1e-12);
    EXPECT_NEAR(a.cov(0, 0), b.cov(0, 0), 1e-10);
  }
}

}  // namespace
}  // namespace proofmass::estimate::fusion_test
