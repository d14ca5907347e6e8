#include "proofmass/estimate/motor/start.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "proofmass/core/linalg.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

double largest(const std::vector<double>& values) {
  double out = 0.0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

// R and K of u = R i + K ω.
Vector2d electrical(const Series& series, const Regimes& regimes) {
  Matrix2d A = Matrix2d::Zero();
  Vector2d b = Vector2d::Zero();
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Vector2d row(series.current_a[k], regimes.speed_radps[k]);
    A += row * row.transpose();
    b += row * series.voltage_v[k];
  }
  A.diagonal() *= 1.0 + 1e-9;
  return solve(A, b);
}

// J, b and Tc of Σ effort = J Δω + b Δθ + Tc Σ sgn ω.
Vector3d mechanical(const Series& series, const Regimes& regimes, const std::vector<double>& effort) {
  constexpr double window_s = 0.25;
  const auto window = std::max<std::size_t>(4, static_cast<std::size_t>(window_s / series.step_s));
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (std::size_t first = 0; first + window < series.size(); first += window / 2) {
    Vector3d row = Vector3d::Zero();
    double impulse = 0.0;
    bool moves = true;
    for (std::size_t k = first; k < first + window; ++k) {
      moves = moves && regimes.rests[k] == 0;
      impulse += 0.5 * (effort[k] + effort[k + 1]) * series.step_s;
      row(1) += regimes.speed_radps[k] * series.step_s;
      row(2) += (regimes.speed_radps[k] > 0.0 ? 1.0 : -1.0) * series.step_s;
    }
    if (!moves) continue;
    row(0) = regimes.speed_radps[first + window] - regimes.speed_radps[first];
    A += row * row.transpose();
    b += row * impulse;
  }
  A.diagonal() *= 1.0 + 1e-6;
  A.diagonal().array() += 1e-12 * (1.0 + A.trace());
  return solve(A, b);
}

void set(Parameters& p, std::size_t i, double value, double mean, double std) {
  p.active[i] = true;
  p.value[i] = value;
  p.prior_mean[i] = mean;
  p.prior_std[i] = std;
}

void set_log(Parameters& p, std::size_t i, double si, double std) {
  set(p, i, std::log(si), std::log(si), std);
}

void set_electrical(const Series& series, double top_v, const Vector2d& found, Parameters& p) {
  constexpr double anything = 5.0;
  const double R = std::max(found(0), 1e-6 * top_v), K = std::max(found(1), 1e-6 * top_v);
  set_log(p, resistance, R, anything);
  set_log(p, torque_constant, K, anything);
  set_log(p, inductance, R * 0.004, 1.0);  // of small motors: 1 to 15 ms
  set(p, brush_drop, 0.0, 0.0, 0.02 * top_v);
  const double noise = std::max(sample_noise(series.current_a), 1e-6 * largest(series.current_a));
  set_log(p, current_noise, noise, anything);
}

void set_measurement(const Series& series, Parameters& p) {
  set(p, half_backlash, 0.0, 0.0, 0.05);
  for (const std::size_t i : {once_cos, once_sin}) set(p, i, 0.0, 0.0, 0.05);
  for (const std::size_t i : {twice_cos, twice_sin}) set(p, i, 0.0, 0.0, 0.02);
  if (series.from_gravity) set(p, radius, 0.0, 0.0, 0.15);
  set(p, delay, 0.0, 0.0, 0.01);
  set_log(p, angle_noise, std::max(sample_noise(series.angle_rad), 1e-6), 5.0);
}

}  // namespace

Parameters start(const Series& series, const Regimes& regimes) {
  Parameters p;
  const double top_v = largest(series.voltage_v), top_radps = largest(regimes.speed_radps);
  std::vector<double> effort = series.voltage_v;
  if (series.has_current()) {
    const Vector2d found = electrical(series, regimes);
    set_electrical(series, top_v, found, p);
    for (std::size_t k = 0; k < effort.size(); ++k)
      effort[k] = p.si(torque_constant) * series.current_a[k];
  }
  const Vector3d found = mechanical(series, regimes, effort);
  const double torque = largest(effort);
  set_log(p, inertia, std::max(found(0), 0.01 * torque / top_radps), 5.0);
  set(p, viscous, found(1), 0.0, 3.0 * torque / top_radps);
  set(p, coulomb, found(2), 0.0, torque);
  set(p, stribeck, 0.0, 0.0, 0.5 * torque);
  set_log(p, stribeck_speed, 0.06 * top_radps, 0.4);
  for (const std::size_t i : {unbalance_cos, unbalance_sin, load_torque})
    set(p, i, 0.0, 0.0, 0.5 * torque);
  double squares = 0.0;
  for (std::size_t k = 1; k < series.size(); ++k)
    squares += std::pow(series.voltage_v[k] - series.voltage_v[k - 1], 2);
  const double span_s = series.step_s * static_cast<double>(series.size());
  set_log(p, voltage_noise, std::sqrt(squares / span_s), 5.0);
  set_log(p, voltage_error, std::max(sample_noise(series.voltage_v), 1e-4 * top_v), 5.0);
  set_log(p, torque_noise, 0.02 * torque * std::sqrt(0.01), 5.0);
  set_measurement(series, p);
  return p;
}

}  // namespace proofmass::estimate::motor
