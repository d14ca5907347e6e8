#pragma once

#include "proofmass/calibrate/tumble.hpp"
#include "proofmass/calibrate/tumble/design.hpp"
#include "proofmass/calibrate/tumble/regression.hpp"

namespace proofmass::calibrate {

/// Input of the coefficients.
struct TumbleSolution {
  const TumbleDesign& design;
  const TumbleRegression& regression;
  const TumbleOptions& options;
  double output_offset = 0.0;      ///< subtracted from all outputs before the regression
  const Eigen::VectorXd& outputs;  ///< minus that
};

/// K1 g = S + 3 T, from the regression.
[[nodiscard]] double amplitude_of(const TumbleDesign& design, const Eigen::VectorXd& beta);

/// Fills coefficients, covariance, shares and the bias in units of the output:
///
///     c = g^k (L·β)/(s·β),   ∂c/∂β = g^k (L − (L·β)/(s·β) s)/(s·β),   ∂c/∂g = k c/g,
///
/// with s·β = S + 3 T and k the power of acceleration in c's unit; K1 = s·β/g.
void find_coefficients(const TumbleSolution& solution, TumbleFit& fit);

}  // namespace proofmass::calibrate
