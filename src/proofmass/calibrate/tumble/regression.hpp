#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

// Least squares with two kinds of errors: each position's own and those of the table's settings.
namespace proofmass::calibrate {

/// Errors of the positions.
struct TumbleErrors {
  Eigen::VectorXd noise_std;  ///< of each output; all 1 if unknown
  bool noise_known = false;
  double noise_dof = 0.0;            ///< 0: infinite
  Eigen::VectorXd lever;             ///< output per radian of indexing: K1 g cos φ
  std::vector<std::size_t> setting;  ///< positions of one number share their error of indexing
  double indexing_std_rad = 0.0;
  bool indexing_assumed = false;  ///< the residuals may show it to be smaller, or larger
  Eigen::MatrixXd drift;       ///< shapes of a drift that is not straight: columns of amplitude 1
  double drift_std = 0.0;      ///< of each shape's size, in the unit of the output
  bool drift_assumed = false;  ///< as indexing_assumed

  /// Whether there are error components besides noise and stated indexing.
  [[nodiscard]] bool with_components() const {
    return indexing_assumed || (drift_std > 0.0 && drift.cols() > 0);
  }
};

/// y = A β + e, cov e = σ² diag(noise_std²) + indexing.
struct TumbleRegression {
  Eigen::VectorXd beta, residual;
  Eigen::MatrixXd noise_covariance;     ///< of β
  Eigen::MatrixXd indexing_covariance;  ///< of β
  Eigen::MatrixXd drift_covariance;     ///< of β
  double indexing_std_rad = 0.0;        ///< as used
  double drift_std = 0.0;               ///< as used, unit of the output
  Eigen::VectorXd residual_variance;    ///< of each residual, as expected
  Eigen::VectorXd deleted;              ///< each against a fit to the others, in its std
  double sigma = 0.0;                   ///< factor on noise_std; of unknown noise its std
  double dof = 0.0;                     ///< of sigma; 0: infinite
  bool noise_known = false;
  double noise_dof = 0.0;   ///< of the stated noise
  double rss = 0.0;         ///< Σ residual²
  double chi_square = 0.0;  ///< rᵀV⁻¹r about the best fit, V of the stated errors (known noise)
  bool has_scale = false;   ///< sigma is known: stated noise, or positions to spare
  TumbleErrors errors;      ///< errors used in the regression
};

/// β = (AᵀWA)⁻¹AᵀWy = G y, W = diag(1/noise_std²);
///
///     cov β = σ² (AᵀWA)⁻¹ + u² G (Σ v vᵀ) Gᵀ,   v the lever of one setting.
///
/// If the noise is unknown σ² = rss/(n − p), with indexing by restricted likelihood
/// (tumble/scatter.hpp); if it is known, σ = 1, or √(χ²/(n − p)) if χ² is significant. If errors
/// are assumed (with_components()) β comes from generalised least squares, V with the sizes of
/// find_sizes(). A must have full rank. Cost: O(n p²), with indexing O(settings · n · p).
[[nodiscard]] TumbleRegression regress_tumble(const Eigen::MatrixXd& A,
                                              const Eigen::VectorXd& y,
                                              const TumbleErrors& errors);

}  // namespace proofmass::calibrate
