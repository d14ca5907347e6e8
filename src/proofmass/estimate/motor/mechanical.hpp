#pragma once

#include <optional>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/motor/electrical.hpp"

namespace proofmass::estimate::motor {

/// Coefficients of the mechanical equation. With a current they are divided by the inertia J: the
/// torque constant, viscous friction, Coulomb friction, load torque, unbalance, and the Stribeck
/// excess. Without one, by the slope B of the voltage over the speed, which then is the first, and
/// the time constant is the second.
enum Mechanical : Eigen::Index {
  drive,
  viscous,
  coulomb,
  load_torque,
  unbalance_cos,
  unbalance_sin,
  stribeck,
  stribeck_speed,  ///< its logarithm
  mechanical_count
};

struct MechanicalFit {
  Eigen::VectorXd value;          ///< Mechanical; stribeck and its speed 0 where they do not show
  Eigen::MatrixXd covariance;     ///< given the electrical coefficients
  Eigen::MatrixXd by_electrical;  ///< derivatives by those, which the speed depends on
  bool shows_stribeck = false;
  double correlation = 0.0;
  double white_std = 0.0;
  std::optional<double> angle_noise_rad{};  ///< without a current
};

/// The drive while it moves, from the speed of the motor and the current:
///
///     J ω' = K i − b ω − (Tc + Fs exp(−(ω/ωs)²)) sgn ω − T0 − U cos(θ + φ),
///
/// integrated once, so that the speed is the measured quantity and what the regression takes as
/// exact, the integrals of current, speed and friction, is far less noisy. Errors of both:
/// not_observable (the load moves too briefly).
[[nodiscard]] Result<MechanicalFit> fit_with_current(const Series& series,
                                                     const Motion& motion,
                                                     const ElectricalFit& electrical);

/// Without a current, with u = R i + K ω:
///
///     B θ = ∫ u dt − J' ω − ∫ (Tc' + Fs' exp(−(ω/ωs)²)) sgn ω dt − …,
///
/// B = K + b R/K, J' = J R/K, friction in volts. Friction at rest and in the gap of the gear is not
/// known, so each motion between rests has a constant of its own.
[[nodiscard]] Result<MechanicalFit> fit_without_current(const Series& series, const Motion& motion);

}  // namespace proofmass::estimate::motor
