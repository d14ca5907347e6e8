#pragma once

#include <Eigen/Core>
#include <vector>

namespace proofmass::calibrate {

/// Scatter of single positions in addition to errors common to several positions.
struct TumbleScatter {
  double sigma = 0.0;
  double dof = 0.0;  ///< of sigma²: 2/its relative variance, 1 at least
};

/// σ of y = A β + e, cov e = V = σ² I + Σ w wᵀ, by restricted maximum likelihood,
///
///     |P y|² = tr P,   P = V⁻¹ − V⁻¹A (AᵀV⁻¹A)⁻¹ AᵀV⁻¹,   dof = σ⁴ tr P²,
///
/// with vectors w that share no position. Expects more rows than columns. If the common errors
/// explain the residuals completely it is √(rss/(n − p)), which is then too large. Source: H. D.
/// Patterson, R. Thompson, Biometrika 58 (1971) 545; S. R. Searle, G. Casella, C. E. McCulloch,
/// Variance Components (1992), 6.6. Cost: O(n p²) a step, 60 steps.
[[nodiscard]] TumbleScatter restricted_scatter(const Eigen::MatrixXd& A,
                                               const Eigen::VectorXd& y,
                                               const std::vector<Eigen::VectorXd>& common);

}  // namespace proofmass::calibrate
