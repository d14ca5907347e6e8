#pragma once

#include <Eigen/Core>

namespace proofmass::characterise {

/// What is known of the mean of independent normal ordinates z.
struct OrdinateMeans {
  /// X: the mean is X b with b free.
  Eigen::MatrixXd fitted;
  /// X̃: what the restricted likelihood makes up for having fitted; may have more columns than X,
  /// those of parameters that are not linear, and stays the same where likelihoods are compared.
  Eigen::MatrixXd adjusting;
};

struct OrdinateFit {
  Eigen::VectorXd strength;      ///< θ, one a column of P
  Eigen::VectorXd density;       ///< S = P θ, one an ordinate
  Eigen::VectorXd coefficients;  ///< b
  Eigen::MatrixXd covariance;    ///< of b, given S
  double log_likelihood = 0.0;
};

/// Generalised least squares with the noise fitted beside: maximises
///
///     ℓ(θ) = −½ Σ [ln S + (z − X b)²/S] − ½ ln |X̃ᵀ S⁻¹ X̃|,     S = P θ,  θ ≥ 0,
///
/// with b at its weighted least squares value. Without X̃ this is the likelihood, with X̃ = X the
/// restricted one; with the tangent of a curve it is the adjusted profile likelihood of what the
/// curve depends on, by which noise is not underestimated for having been fitted through.
/// Source: H. D. Patterson, R. Thompson, Biometrika 58 (1971) 545; D. R. Cox, N. Reid, J. Roy.
/// Statist. Soc. B 49 (1987) 1. By Fisher scoring as in whittle.hpp.
///
/// start: a θ to begin from; empty: from the smoothed squares of z.
[[nodiscard]] OrdinateFit fit_ordinates(const Eigen::VectorXd& z,
                                        const Eigen::MatrixXd& P,
                                        const OrdinateMeans& means,
                                        const Eigen::VectorXd& start = {});

/// What one more column c, of strength zero so far, promises to add to twice the log-likelihood:
/// its score test, (½ Σ c (p − S)/S²)² over what of its information ½ Σ c²/S² the strengths above
/// zero do not share, p the expected squares; 0 where the score points below zero. Source: C. R.
/// Rao, Proc. Camb. Phil. Soc. 44 (1948) 50.
[[nodiscard]] double promised_gain(const Eigen::VectorXd& z,
                                   const Eigen::MatrixXd& P,
                                   const OrdinateMeans& means,
                                   const OrdinateFit& fit,
                                   const Eigen::VectorXd& column);

/// fit_ordinates with θ given.
[[nodiscard]] OrdinateFit evaluate_ordinates(const Eigen::VectorXd& z,
                                             const Eigen::MatrixXd& P,
                                             const OrdinateMeans& means,
                                             const Eigen::VectorXd& strength);

}  // namespace proofmass::characterise
