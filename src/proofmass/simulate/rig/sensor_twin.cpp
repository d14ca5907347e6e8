#include "proofmass/simulate/rig/sensor_twin.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "proofmass/core/linalg.hpp"
#include "proofmass/sensor/noise_conversions.hpp"
#include "proofmass/simulate/rig/converter.hpp"

namespace proofmass::simulate {
namespace {

/// Standard deviation of a uniform draw within ± limit, as a fraction of the limit.
constexpr double even_std = 1.0 / std::numbers::sqrt3;

void draw_bias(const RigOptions& options, std::size_t index, RigSensor& sensor) {
  Random random(options.seed, "bias", index);
  for (double& bias : sensor.bias_mps2) bias += options.bias_spread_mps2 * random.uniform();
}

void draw_datasheet_errors(const RigOptions& options, std::size_t index, RigSensor& sensor) {
  const auto& sheet = sensor::adxl335;
  const double scale_spread =
      *sheet.sensitivity_v_per_mps2.max / *sheet.sensitivity_v_per_mps2.typ - 1.0;
  Random random(options.seed, "datasheet errors", index);
  for (double& a : sensor.misalignment_rad) a += sheet.interaxis_alignment_rad * random.uniform();
  for (double& c : sensor.cross_axis) c += sheet.cross_axis * random.uniform();
  for (double& s : sensor.scale) s *= 1.0 + scale_spread * random.uniform();
  sensor.nonlinearity += sheet.nonlinearity * random.uniform();
}

Eigen::Matrix3d error_matrix(const RigSensor& sensor) {
  const auto& [xy, xz, yx, yz, zx, zy] = sensor.cross_axis;
  const auto& [a_yz, a_zy, a_zx] = sensor.misalignment_rad;
  Eigen::Matrix3d cross, T;
  cross << 1.0, xy, xz, yx, 1.0, yz, zx, zy, 1.0;
  T << 1.0, -a_yz, a_zy, 0.0, 1.0, -a_zx, 0.0, 0.0, 1.0;
  return cross * Eigen::Vector3d(sensor.scale.data()).asDiagonal() * T.inverse();
}

double rotation_angle(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(twice_sine.norm(), R.trace() - 1.0);
}

constexpr const char* origin = "simulated";

sensor::Electrical electrical_of(const RigSensor& sensor, const RigOptions& options) {
  const auto same = [](double value, const char* unit) {
    return sensor::make_axis_figures({value, value, value}, unit, origin);
  };
  sensor::Electrical electrical;
  electrical.supply = sensor::make_figure(options.supply.nominal_v, "V", origin);
  electrical.reference_supply = electrical.supply;
  if (options.supply.recorded) electrical.supply_channel = "supply";
  electrical.sensitivity = same(sensor.sensitivity_v_per_mps2, "V/(m/s^2)");
  electrical.zero_g_fraction = same(sensor.zero_g_fraction, "1");
  electrical.bandwidth = same(sensor.bandwidth_hz, "Hz");
  if (options.daq.bits > 0)
    electrical.lsb = sensor::make_figure(daq_lsb_v(options.daq), "V", origin);
  return electrical;
}

}  // namespace

SensorTwin::SensorTwin(const RigOptions& options, std::size_t index)
    : sensor(options.sensors[index]) {
  alignment_std_rad = unseen_turn_rad(error_matrix(sensor));
  draw_bias(options, index, sensor);
  if (options.datasheet_errors) {
    draw_datasheet_errors(options, index, sensor);
    alignment_std_rad = std::hypot(alignment_std_rad, even_std * sensor::adxl335.cross_axis,
                                   even_std * sensor::adxl335.interaxis_alignment_rad);
  }
  position_m = sensor.radius_m *
               Eigen::Vector3d(std::cos(sensor.position_rad), std::sin(sensor.position_rad), 0.0);
  const Eigen::Matrix3d R_wheel_sensor =
      (Eigen::AngleAxisd(sensor.mounting_rad, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(sensor.tilt_y_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(sensor.tilt_x_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  R_sensor_wheel = R_wheel_sensor.transpose();
  M = error_matrix(sensor);
}

double SensorTwin::warm_up(double t_s) const {
  return -std::expm1(-t_s / sensor.warm_up_time_s);
}

AxisTwin::AxisTwin(const SensorTwin& twin,
                   const RigOptions& options,
                   std::size_t sensor,
                   std::size_t axis)
    : sensor_(&twin.sensor),
      axis_(axis),
      walk_step_mps2_(twin.sensor.bias_walk_mps2_rts[axis] * std::sqrt(1.0 / options.rate_hz)),
      filtered_rms_(sensor::filtered_noise_rms(twin.sensor.noise_density_mps2_rthz[axis],
                                               twin.sensor.bandwidth_hz)),
      memory_(
          std::exp(-2.0 * std::numbers::pi * twin.sensor.bandwidth_hz * (1.0 / options.rate_hz))),
      renewed_mps2_(std::sqrt(1.0 - memory_ * memory_) * filtered_rms_),
      white_(options.seed, "white noise", 3 * sensor + axis),
      density_(options.seed, "filtered noise", 3 * sensor + axis),
      walk_(options.seed, "bias walk", 3 * sensor + axis) {
  if (filtered_rms_ > 0.0)  // stationary from the start
    filtered_mps2_ = filtered_rms_ * density_.normal();
}

double AxisTwin::bias_mps2(double warm_up) const {
  return sensor_->bias_mps2[axis_] + sensor_->warm_up_mps2[axis_] * warm_up + walk_mps2_;
}

double AxisTwin::reading_mps2(double u_mps2, double warm_up) const {
  const double full_scale = sensor_->full_scale_mps2;
  const double bent = u_mps2 + sensor_->nonlinearity * u_mps2 * u_mps2 / full_scale;
  return std::clamp(bent + bias_mps2(warm_up), -full_scale, full_scale);
}

// White noise after one pole is exactly a first-order autoregression at evenly spaced times. Each
// kind draws from its own stream: one that is disabled need not be drawn.
double AxisTwin::next_noise_mps2() {
  double noise = filtered_mps2_;
  if (filtered_rms_ > 0.0)
    filtered_mps2_ = memory_ * filtered_mps2_ + renewed_mps2_ * density_.normal();
  const double white_rms = sensor_->noise_rms_mps2[axis_];
  if (white_rms > 0.0) noise += white_rms * white_.normal();
  return noise;
}

void AxisTwin::step_walk() {
  if (walk_step_mps2_ > 0.0) walk_mps2_ += walk_step_mps2_ * walk_.normal();
}

sensor::Calibration calibration_of(const Eigen::Matrix3d& M, const Axes& bias_mps2) {
  // M⁻¹ = Q U: a calibration against gravity finds U; the rotation Q is not observable.
  const Eigen::Matrix3d U = positive_qr(M.inverse()).U;
  const Eigen::Vector3d scale = U.diagonal().cwiseInverse();
  sensor::Calibration calibration;
  calibration.bias = sensor::make_axis_figures(bias_mps2, "m/s^2", origin);
  calibration.scale = sensor::make_axis_figures({scale(0), scale(1), scale(2)}, "1", origin);
  calibration.misalignment = sensor::make_axis_figures(
      {-U(0, 1) * scale(1), U(0, 2) * scale(2), -U(1, 2) * scale(2)}, "rad", origin);
  return calibration;
}

double unseen_turn_rad(const Eigen::Matrix3d& M) {
  return rotation_angle(positive_qr(M.inverse()).Q);
}

OnePole::OnePole(double bandwidth_hz) : tau_s_(1.0 / (2.0 * std::numbers::pi * bandwidth_hz)) {}

double OnePole::next(double t_s, double input) {
  if (!started_) {
    output_ = input;
    started_ = true;
  } else if (t_s > t_s_) {
    const double lag = (input - input_) / (t_s - t_s_) * tau_s_;
    output_ = input - lag + (output_ - input_ + lag) * std::exp((t_s_ - t_s) / tau_s_);
  }
  t_s_ = t_s;
  input_ = input;
  return output_;
}

sensor::SensorModel model_of(const SensorTwin& twin, const RigOptions& options, std::size_t index) {
  const RigSensor& s = twin.sensor;
  sensor::SensorModel model;
  model.name = "simulated sensor " + std::to_string(index + 1);
  model.serial = "seed " + std::to_string(options.seed);
  model.electrical = electrical_of(s, options);
  Axes warmed_up = s.bias_mps2;
  for (std::size_t axis = 0; axis < 3; ++axis) warmed_up[axis] += s.warm_up_mps2[axis];
  model.calibration = calibration_of(twin.M, warmed_up);
  model.calibration.gravity = sensor::make_figure(options.gravity_mps2, "m/s^2", origin);
  model.calibration.alignment_std = sensor::make_figure(twin.alignment_std_rad, "rad", origin);
  Axes white{};  // N as sampled: both kinds are flat below the filter's corner
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const sensor::FilteredWhite filtered{sensor::two_sided_density(s.noise_density_mps2_rthz[axis]),
                                         s.bandwidth_hz};
    white[axis] = std::hypot(s.noise_rms_mps2[axis] / std::sqrt(options.rate_hz),
                             sensor::folded_density_rthz(filtered, options.rate_hz));
  }
  model.noise.white = sensor::make_axis_figures(white, "m/s^2/sqrt(Hz)", origin);
  model.noise.random_walk =
      sensor::make_axis_figures(s.bias_walk_mps2_rts, "m/s^2/sqrt(s)", origin);
  model.drift.a1 = sensor::make_axis_figures(s.warm_up_mps2, "m/s^2", origin);
  model.drift.a2 = sensor::make_axis_figures(s.bias_mps2, "m/s^2", origin);
  model.drift.time_constant = sensor::make_axis_figures(
      {s.warm_up_time_s, s.warm_up_time_s, s.warm_up_time_s}, "s", origin);
  return model;
}

}  // namespace proofmass::simulate
