#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/tumble_regression.hpp"

// Errors of a tumble whose sizes are assumed rather than known: how large the residuals allow them
// to be.
namespace proofmass::calibrate {

/// Standard deviations: a factor on the noise of the outputs, the table's angle, the bias's wander.
struct TumbleSizes {
  double noise = 1.0, indexing_rad = 0.0, drift = 0.0;
};

/// V = s² diag(noise_std²) + u² Σ v vᵀ + d² Z Zᵀ, v the levers of the settings, Z the shapes of the
/// drift. Cost: O(rows · columns) a product.
class TumbleCovariance {
 public:
  TumbleCovariance(const TumbleErrors& errors, const TumbleSizes& sizes);

  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& X) const;  ///< V⁻¹ X
  [[nodiscard]] Eigen::VectorXd inverse_diagonal() const;
  [[nodiscard]] double log_determinant() const { return log_determinant_; }

 private:
  [[nodiscard]] Eigen::MatrixXd solve_settings(const Eigen::MatrixXd& X) const;

  const TumbleErrors& errors_;
  Eigen::VectorXd weight_;  ///< 1/(s noise_std)²
  Eigen::VectorXd lever_;   ///< u v
  Eigen::VectorXd square_;  ///< 1 + Σ lever² weight of each setting
  Eigen::MatrixXd drift_;   ///< V₀⁻¹ d Z, V₀ without the drift
  Eigen::MatrixXd inner_;   ///< (I + d² Zᵀ V₀⁻¹ Z)⁻¹
  double log_determinant_ = 0.0;
};

/// Generalised least squares with one covariance.
struct TumbleSolved {
  Eigen::VectorXd beta;
  Eigen::MatrixXd covariance;   ///< of β
  Eigen::MatrixXd gain;         ///< β = gain y
  Eigen::VectorXd projected;    ///< P y, P = V⁻¹ − V⁻¹A (AᵀV⁻¹A)⁻¹ AᵀV⁻¹
  Eigen::VectorXd projector;    ///< diagonal of P
  double chi_square = 0.0;      ///< yᵀ P y
  double log_likelihood = 0.0;  ///< restricted
  /// Deletion residual over its standard deviation: (P y)_k/√P_kk.
  [[nodiscard]] double deleted(Eigen::Index k) const;
};
[[nodiscard]] TumbleSolved solve_tumble(const Eigen::MatrixXd& A,
                                        const Eigen::VectorXd& y,
                                        const TumbleErrors& errors,
                                        const TumbleSizes& sizes);

/// The sizes to be used. Those that are assumed (errors.indexing_assumed, errors.drift_assumed)
/// become the largest that the residuals allow (2 ln L 2.7 below its maximum, one-sided 95 %), but
/// no larger than assumed; where the residuals ask for more than was assumed, the upper bound of
/// 2 ln L 1 below the maximum. The factor on a stated noise is 1 unless χ² is beyond chance (p <
/// 0.01) whatever the other sizes; a noise of 0 is of residuals that are zero.
/// Source: H. D. Patterson, R. Thompson, Biometrika 58 (1971) 545, restricted likelihood.
[[nodiscard]] TumbleSizes find_sizes(const Eigen::MatrixXd& A,
                                     const Eigen::VectorXd& y,
                                     const TumbleErrors& errors);

}  // namespace proofmass::calibrate
