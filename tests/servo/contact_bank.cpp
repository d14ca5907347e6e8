#include "contact_bank.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"
#include "proofmass/servo/loop/linear_motor.hpp"

namespace proofmass::servo_comparison {
namespace {

enum State : int { motor_angle, motor_speed, motor_current, load_torque, play, bias_x, bias_y };
enum Contact : std::size_t { backwards, gap, forwards };

// Smallest probability of a mode, so that none is lost, and that below which it is not mixed.
constexpr double least = 1e-9, negligible = 1e-12;

double below_zero(double mean, double variance) {
  return 0.5 * std::erfc(mean / std::sqrt(2.0 * std::max(variance, 1e-18)));
}

}  // namespace

ContactBank::ContactBank(const servo::MotorObserverOptions& options)
    : options_(options), half_rad_(std::max(0.5 * options.model.backlash_rad, 1e-9)) {
  for (std::size_t which = 0; which < modes; ++which) {
    Mode& mode = modes_[which];
    mode.x(play) = end_of(which);
    mode.P(motor_angle, motor_angle) =
        square(options.bias_std_mps2 / options.gravity_mps2) + square(half_rad_);
    mode.P(motor_speed, motor_speed) = 1e-4;
    mode.P(motor_current, motor_current) = 1e-2;
    mode.P(load_torque, load_torque) = square(0.1 * options.model.coulomb_nm + 0.01);
    if (which == gap) mode.P(play, play) = square(half_rad_) / 3.0;
    mode.P(bias_x, bias_x) = mode.P(bias_y, bias_y) = square(options.bias_std_mps2);
  }
}

double ContactBank::end_of(std::size_t which) const {
  return (static_cast<double>(which) - 1.0) * half_rad_;
}

void ContactBank::advance(double voltage_v, std::size_t which) {
  constexpr double probe = 1e-4;
  const servo::MotorModel& m = options_.model;
  Mode& mode = modes_[which];
  const double w = mode.x(motor_speed), h = options_.step_s;
  const double slope =
      std::max(0.0, (m.dry_friction_nm(w + probe) - m.dry_friction_nm(w - probe)) / (2.0 * probe));
  const servo::SampledMotor step =
      servo::sampled(m, m.viscous_nmspr + slope, options_.torque_noise, h);
  const double torque = -(m.dry_friction_nm(w) - slope * w) + mode.x(load_torque);
  Covariance F = Covariance::Identity();
  F.topLeftCorner<3, 3>() = step.F;
  F.block<3, 1>(0, load_torque) = step.from_torque;
  if (which == gap)
    F(play, motor_speed) = h;
  else
    F.row(play).setZero();
  mode.x.head<3>() =
      (step.F * mode.x.head<3>() + step.from_voltage * voltage_v + step.from_torque * torque)
          .eval();
  mode.x(play) = which == gap ? mode.x(play) + 0.5 * h * (w + mode.x(motor_speed)) : end_of(which);
  mode.P = (F * mode.P * F.transpose()).eval();
  mode.P.topLeftCorner<3, 3>() += step.Q;
  mode.P(load_torque, load_torque) += square(options_.load_torque_walk) * h;
  if (which == gap) mode.P(play, play) += square(0.05 * half_rad_) * h;
}

void ContactBank::mix() {
  Eigen::Matrix3d to = Eigen::Matrix3d::Zero();  // row: from, column: to
  const auto speed_below_zero = [&](std::size_t which) {
    const Mode& mode = modes_[which];
    return below_zero(mode.x(motor_speed), mode.P(motor_speed, motor_speed));
  };
  to(forwards, gap) = speed_below_zero(forwards);
  to(forwards, forwards) = 1.0 - to(forwards, gap);
  to(backwards, backwards) = speed_below_zero(backwards);
  to(backwards, gap) = 1.0 - to(backwards, backwards);
  const double at = modes_[gap].x(play), spread = modes_[gap].P(play, play);
  to(gap, forwards) = below_zero(half_rad_ - at, spread);
  to(gap, backwards) = below_zero(half_rad_ + at, spread);
  to(gap, gap) = std::max(0.0, 1.0 - to(gap, forwards) - to(gap, backwards));

  const std::array<Mode, modes> from = modes_;
  for (std::size_t target = 0; target < modes; ++target) {
    std::array<double, modes> share{};
    double total = 0.0;
    const auto column = static_cast<Eigen::Index>(target);
    for (std::size_t k = 0; k < modes; ++k)
      total += share[k] = from[k].probability * to(static_cast<Eigen::Index>(k), column);
    Mode& mode = modes_[target];
    mode.probability = total;
    if (total < negligible) continue;
    std::array<State, modes> x;
    mode.x.setZero();
    for (std::size_t k = 0; k < modes; ++k) {
      x[k] = from[k].x;
      x[k](play) = target == gap ? std::clamp(x[k](play), -half_rad_, half_rad_) : end_of(target);
      mode.x += share[k] / total * x[k];
    }
    mode.P.setZero();
    for (std::size_t k = 0; k < modes; ++k) {
      Covariance P = from[k].P;
      if (target != gap) {
        P.row(play).setZero();
        P.col(play).setZero();
      }
      const State apart = x[k] - mode.x;
      mode.P += share[k] / total * (P + apart * apart.transpose());
    }
  }
}

void ContactBank::predict(double voltage_v) {
  for (std::size_t which = 0; which < modes; ++which) advance(voltage_v, which);
  mix();
}

// Returns the log likelihood, less a constant.
double ContactBank::correct(const servo::MotorSample& sample, Mode& mode) const {
  double likelihood = 0.0;
  const auto measure = [&](const State& H, double innovation, double variance) {
    const State PH = mode.P * H;
    const double S = variance + H.dot(PH);
    likelihood -= 0.5 * (std::log(S) + innovation * innovation / S);
    mode.x += PH / S * innovation;
    mode.P -= PH * PH.transpose() / S;
  };
  const double g = options_.gravity_mps2;
  for (const int axis : {0, 1}) {
    const double angle = mode.x(motor_angle) - mode.x(play);
    const double seen = axis == 0 ? g * std::sin(angle) : g * std::cos(angle);
    const double slope = axis == 0 ? g * std::cos(angle) : -g * std::sin(angle);
    State H = State::Zero();
    H(motor_angle) = slope;
    H(play) = -slope;
    H(bias_x + axis) = 1.0;
    const double value = sample.accel_mps2[static_cast<std::size_t>(axis)];
    measure(H, value - seen - mode.x(bias_x + axis), square(options_.accel_std_mps2));
  }
  State H = State::Zero();
  H(motor_current) = 1.0;
  measure(H, sample.current_a - mode.x(motor_current), square(options_.current_std_a));
  return likelihood;
}

void ContactBank::update(const servo::MotorSample& sample) {
  std::array<double, modes> likelihood{};
  for (std::size_t which = 0; which < modes; ++which)
    likelihood[which] = correct(sample, modes_[which]);
  modes_[gap].x(play) = std::clamp(modes_[gap].x(play), -half_rad_, half_rad_);
  const double best = std::ranges::max(likelihood);
  double total = 0.0;
  for (std::size_t which = 0; which < modes; ++which)
    total += modes_[which].probability *= std::exp(likelihood[which] - best);
  for (Mode& mode : modes_) mode.probability = std::max(mode.probability / total, least);
}

Uncertain ContactBank::load_rad() const {
  double mean = 0.0, total = 0.0, variance = 0.0;
  for (const Mode& mode : modes_) {
    mean += mode.probability * (mode.x(motor_angle) - mode.x(play));
    total += mode.probability;
  }
  mean /= total;
  for (const Mode& mode : modes_) {
    const double apart = mode.x(motor_angle) - mode.x(play) - mean;
    variance += mode.probability / total *
                (mode.P(motor_angle, motor_angle) - 2.0 * mode.P(motor_angle, play) +
                 mode.P(play, play) + apart * apart);
  }
  return {mean, std::sqrt(std::max(variance, 0.0))};
}

}  // namespace proofmass::servo_comparison
