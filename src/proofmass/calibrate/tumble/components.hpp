#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/tumble/regression.hpp"

// Tumble errors of assumed size: the sizes allowed by the residuals.
namespace proofmass::calibrate {

/// Standard deviations: a factor on the noise of the outputs, the table's angle, the bias drift.
struct TumbleSizes {
  double noise = 1.0, indexing_rad = 0.0, drift = 0.0;
};

/// V = s² diag(noise_std²) + u² Σ v vᵀ + d² Z Zᵀ, v the sensitivities of the settings, Z the shapes
/// of the drift. Cost: O(rows · columns) a product.
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

/// The sizes to use.
///
/// - Assumed sizes (errors.indexing_assumed, errors.drift_assumed) become the largest allowed by
///   the residuals (2 ln L 2.7 below its maximum, one-sided 95 %), at most the assumed value.
/// - If the residuals require more than assumed, the upper bound of 2 ln L 1 below the maximum.
/// - The factor on a stated noise is 1 unless χ² is significant (p < 0.01) for all other sizes; a
///   noise of 0 belongs to residuals that are zero.
///
/// Source: H. D. Patterson, R. Thompson, Biometrika 58 (1971) 545, restricted likelihood.
[[nodiscard]] TumbleSizes find_sizes(const Eigen::MatrixXd& A,
                                     const Eigen::VectorXd& y,
                                     const TumbleErrors& errors);

}  // namespace proofmass::calibrate
