#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace proofmass::estimate::motor {

/// Parameters of the drive, in coordinates of its output shaft, and of its measurements. Without a
/// current they are those of J' ω' = u − B ω − T'(ω): `inertia` is J R/K (V s²/rad), `viscous` is
/// K + b R/K (V s/rad), and the torques are in volts.
enum Index : std::size_t {
  resistance,       ///< ohm, log
  torque_constant,  ///< N m/A = V s/rad, log
  inductance,       ///< H, log
  brush_drop,       ///< V
  inertia,          ///< kg m², log
  viscous,          ///< N m s/rad
  coulomb,          ///< N m
  stribeck,         ///< excess at speed zero, N m
  stribeck_speed,   ///< rad/s, log
  unbalance_cos,
  unbalance_sin,  ///< N m
  load_torque,    ///< constant, N m
  half_backlash,  ///< rad
  once_cos,
  once_sin,
  twice_cos,
  twice_sin,  ///< error of the measured angle with the turn, rad
  radius,     ///< of a sensor that is not opposed by another, m
  delay,      ///< of the angle against the voltage, s
  torque_noise,
  voltage_noise,  ///< √density of the torque, and of the voltage's random walk, log
  current_noise,
  angle_noise,
  voltage_error,  ///< standard deviation of a sample, log
  parameter_count
};

using Values = std::array<double, parameter_count>;

[[nodiscard]] constexpr bool is_log(std::size_t i) {
  return i <= inductance || i == inertia || i == stribeck_speed || i >= torque_noise;
}

/// Values in the coordinates of the search (logarithms where is_log), each with a normal prior.
struct Parameters {
  Values value{}, prior_mean{}, prior_std{};
  std::array<bool, parameter_count> active{};

  [[nodiscard]] double si(std::size_t i) const { return is_log(i) ? std::exp(value[i]) : value[i]; }
};

/// Friction torque at a speed, with its sign.
/// Source: B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, A survey of models, analysis tools
/// and compensation methods for the control of machines with friction, Automatica 30 (1994), eq. 9.
[[nodiscard]] inline double dry_friction_nm(const Parameters& p, double speed_radps) {
  const double ratio = speed_radps / p.si(stribeck_speed);
  const double size = p.value[coulomb] + p.value[stribeck] * std::exp(-ratio * ratio);
  return speed_radps < 0.0 ? -size : size;
}

}  // namespace proofmass::estimate::motor
