#pragma once

#include <Eigen/Core>

#include "proofmass/estimate/motor/series.hpp"

namespace proofmass::estimate::motor {

/// Errors of the load's angle as nuisances of a regression:
///
/// - its delay against the voltage;
/// - once and twice per turn, what bias, scale and skew of an accelerometer leave, or an encoder's
///   eccentricity; three and four times, what nonlinearity leaves;
/// - the distance from the axle of a sensor that is not opposed by another.
class AngleErrors {
 public:
  AngleErrors(const Series& series, const Motion& motion);

  [[nodiscard]] Eigen::Index count() const {
    return 1 + 2 * orders + (series_.from_gravity ? 1 : 0);
  }
  /// Standard deviations of the coefficients, about zero.
  void set_priors(Eigen::Ref<Eigen::VectorXd> std) const;
  /// Derivatives of the measured angle by the coefficients.
  void write(std::size_t k, Eigen::Ref<Eigen::VectorXd> row) const;

 private:
  static constexpr Eigen::Index orders = 4;

  const Series& series_;
  const Motion& motion_;
  std::vector<double> accel_radps2_;
};

}  // namespace proofmass::estimate::motor
