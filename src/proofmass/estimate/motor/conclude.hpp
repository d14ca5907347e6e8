#pragma once

#include "proofmass/estimate/motor.hpp"
#include "proofmass/estimate/motor/current_errors.hpp"

namespace proofmass::estimate::motor {

/// Coefficients of both equations with their joint covariance, and the scales against which their
/// uncertainty is judged.
class Findings {
 public:
  Findings(const Identified& found, const CurrentErrors& errors);

  /// The drive's figures with intervals, and what the recording does not determine.
  [[nodiscard]] std::vector<MotorParameter> parameters() const;
  /// Friction over the recorded speeds: with a current viscous and dry friction in N m, without one
  /// dry friction in V.
  [[nodiscard]] std::vector<FrictionPoint> friction_curve() const;
  [[nodiscard]] double friction_at(double speed_radps) const;

 private:
  /// A function of the coefficients with its standard deviation by its gradient.
  template <class Function>
  [[nodiscard]] Uncertain figure(const Function& of) const;
  [[nodiscard]] std::vector<MotorParameter> with_current() const;
  [[nodiscard]] std::vector<MotorParameter> without_current() const;
  [[nodiscard]] MotorParameter backlash() const;

  Eigen::VectorXd value_;  ///< Electrical, then Mechanical
  Eigen::MatrixXd covariance_;
  bool has_current_, has_both_flanks_, shows_stribeck_;
  double half_backlash_rad_ = 0.0, half_backlash_std_rad_ = 0.0;
  double top_radps_, rest_radps_, top_effort_;  ///< largest current or voltage
};

}  // namespace proofmass::estimate::motor
