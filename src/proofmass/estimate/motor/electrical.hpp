#pragma once

#include "proofmass/estimate/motor/level_regression.hpp"
#include "proofmass/estimate/motor/series.hpp"

namespace proofmass::estimate::motor {

/// Coefficients of the electrical equation, divided by the torque constant K.
enum Electrical : Eigen::Index {
  per_constant,
  resistance,
  inductance,
  brush_drop,
  brush_knee,  ///< ln of the current within which the brushes' drop changes its sign
  offset,      ///< constant error of the voltage, less R times that of the current
  electrical_count
};

/// Where the fit starts: coefficients about which it is linear, or depend on which its priors do.
struct ElectricalStart {
  double resistance_per_constant = 0.0;
  double brush_drop_per_constant = 0.0, brush_knee_a = 0.0;
};

/// The winding and the gear: from u = R i + L i' + Vb tanh(i/s) + u0 + K ω the motor's angle is
///
///     θ_m = (1/K) ∫ (u − R i − Vb tanh(i/s) − u0) dt − (L/K) i,
///
/// up to the random walk that the errors of voltage and current integrate to, and the angle
/// measured at the load is
///
///     θ = θ_m ∓ δ − τ ω + up to four times per turn − r (ω² cos θ + ω' sin θ) / g + noise,
///
/// linear in 1/K, R/K, L/K, Vb/K, u0/K, half the backlash δ, the delay τ and the errors of the
/// angle; Newton's steps find the current s over which the brushes' drop rises. The
/// motor's angle is known through the gap of the gear, where the load rests, so that the change of
/// flank shows the backlash.
struct ElectricalFit {
  Eigen::VectorXd value;  ///< Electrical, 1/(V s/rad) times V, Ω, H or V
  Eigen::MatrixXd covariance;
  double half_backlash_rad = 0.0, half_backlash_std_rad = 0.0;
  double angle_noise_rad = 0.0;
  double correlation = 0.0;
  /// The motor's speed is Σ value · terms; one column for each coefficient, a row for each sample.
  Eigen::MatrixXd speed_terms;
  ElectricalStart next{};  ///< for a fit to a similar motion
  std::vector<double> motor_angle_rad{};
  std::vector<double> load_angle_rad{};  ///< by the back-EMF alone, without the random walk
};

/// Expects a current, and some samples with contact.
[[nodiscard]] ElectricalFit fit_electrical(const Series& series,
                                           const Motion& motion,
                                           const ElectricalStart& start);

/// R/K by u = R i + K ω at each sample.
[[nodiscard]] double resistance_per_constant(const Series& series, const Motion& motion);

}  // namespace proofmass::estimate::motor
