#include "proofmass/servo/loop/observer.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "proofmass/servo/loop/linear_motor.hpp"

namespace proofmass::servo {
namespace {

enum State : std::size_t {
  motor_angle,
  motor_speed,
  motor_current,
  load_torque,
  play,
  bias_x,
  bias_y
};

}  // namespace

MotorObserver::MotorObserver(const MotorObserverOptions& options, double load_rad)
    : options_(options) {
  const double half = 0.5 * options.model.backlash_rad;
  x_[motor_angle] = load_rad;
  P_[motor_angle][motor_angle] =
      std::pow(options.bias_std_mps2 / options.gravity_mps2, 2) + half * half;
  P_[motor_speed][motor_speed] = 1e-4;
  P_[motor_current][motor_current] = 1e-2;
  P_[load_torque][load_torque] = std::pow(0.1 * options.model.coulomb_nm + 0.01, 2);
  P_[play][play] = half * half / 3.0 + 1e-12;
  P_[bias_x][bias_x] = P_[bias_y][bias_y] = std::pow(options.bias_std_mps2, 2);
}

void MotorObserver::predict(double voltage_v) {
  constexpr double probe = 1e-4;
  const MotorModel& m = options_.model;
  const double w = x_[motor_speed], h = options_.step_s,
               half = std::max(0.5 * m.backlash_rad, 1e-9);
  const double slope =
      std::max(0.0, (m.dry_friction_nm(w + probe) - m.dry_friction_nm(w - probe)) / (2.0 * probe));
  const SampledMotor step = sampled(m, m.viscous_nmspr + slope, options_.torque_noise, h);
  const double torque = -(m.dry_friction_nm(w) - slope * w) + x_[load_torque];
  // The play, and its derivatives.
  const double along = w < 0.0 ? -1.0 : 1.0, filled = std::clamp(x_[play] * along / half, 0.0, 1.0);
  const double open = 1.0 - filled * filled;
  const double kept = std::clamp(1.0 - h * std::abs(w) * 2.0 * filled / half, 0.0, 1.0);
  const double next_play = std::clamp(x_[play] + h * w * open, -half, half);

  Eigen::Matrix<double, states, states> F = Eigen::Matrix<double, states, states>::Identity();
  F.topLeftCorner<3, 3>() = step.F;
  F.block<3, 1>(0, load_torque) = step.from_torque;
  F(play, motor_speed) = h * open;
  F(play, play) = kept;
  const Eigen::Vector3d motion = step.F * Eigen::Vector3d(x_[0], x_[1], x_[2]) +
                                 step.from_voltage * voltage_v + step.from_torque * torque;
  Eigen::Map<Eigen::Matrix<double, states, states, Eigen::RowMajor>> P(P_[0].data());
  P = (F * P * F.transpose()).eval();
  P.topLeftCorner<3, 3>() += step.Q;
  P(load_torque, load_torque) += options_.load_torque_walk * options_.load_torque_walk * h;
  // A motor that slows down faster than the load by its friction is overrun by it.
  constexpr double overrun_radps2 = 10.0;
  const double braking = -along * (motion(1) - w) / h;
  const double overrun = std::clamp(braking / overrun_radps2 - 1.0, 0.0, 1.0);
  P(play, play) += std::pow(0.05 * half, 2) * h + half * h * std::abs(w) * std::max(open, overrun);
  x_[motor_angle] = motion(0);
  x_[motor_speed] = motion(1);
  x_[motor_current] = motion(2);
  x_[play] = next_play;
}

void MotorObserver::measure(const Row& H, double innovation, double variance) {
  Row PH{};
  double S = variance;
  for (std::size_t i = 0; i < states; ++i) {
    for (std::size_t j = 0; j < states; ++j) PH[i] += P_[i][j] * H[j];
    S += H[i] * PH[i];
  }
  for (std::size_t i = 0; i < states; ++i) {
    x_[i] += PH[i] / S * innovation;
    for (std::size_t j = 0; j < states; ++j) P_[i][j] -= PH[i] * PH[j] / S;
  }
}

void MotorObserver::update(const MotorSample& sample) {
  const double g = options_.gravity_mps2, variance = std::pow(options_.accel_std_mps2, 2);
  const double half = 0.5 * options_.model.backlash_rad;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double angle = x_[motor_angle] - x_[play];
    const double seen = axis == 0 ? g * std::sin(angle) : g * std::cos(angle);
    const double slope = axis == 0 ? g * std::cos(angle) : -g * std::sin(angle);
    Row H{};
    H[motor_angle] = slope;
    H[play] = -slope;
    H[bias_x + axis] = 1.0;
    measure(H, sample.accel_mps2[axis] - seen - x_[bias_x + axis], variance);
  }
  Row of_current{};
  of_current[motor_current] = 1.0;
  measure(of_current, sample.current_a - x_[motor_current], std::pow(options_.current_std_a, 2));
  x_[play] = std::clamp(x_[play], -half, half);
}

Uncertain MotorObserver::load_rad() const {
  const double var = P_[motor_angle][motor_angle] - 2.0 * P_[motor_angle][play] + P_[play][play];
  return {x_[motor_angle] - x_[play], std::sqrt(std::max(var, 0.0))};
}

Uncertain MotorObserver::speed_radps() const {
  return {x_[motor_speed], std::sqrt(std::max(P_[motor_speed][motor_speed], 0.0))};
}

}  // namespace proofmass::servo
