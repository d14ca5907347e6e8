#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/norm_model.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::calibrate {

/// Which of the nine parameters are free: the first six, with axes taken for orthogonal, or all.
enum class NormParameters { six = 6, nine = 9 };

struct NormFit {
  Parameters p;
  Eigen::MatrixXd cofactor;     ///< (JᵀWJ)⁻¹ of the free parameters: times s² their covariance
  std::vector<NormTerm> terms;  ///< of every pose, used or not
  /// jᵀ cofactor j / variance of every pose: its leverage where it was used, else the part of its
  /// residual's variance that the parameters bring.
  std::vector<double> leverage;
  std::size_t used = 0;
  double rss = 0.0;  ///< Σ residual²/variance of those used
  double condition = 0.0;
  int iterations = 0;
  bool converged = false;

  [[nodiscard]] std::size_t dof() const {
    const auto free = static_cast<std::size_t>(cofactor.rows());
    return used > free ? used - free : 0;
  }
};

/// Least Σ weight · residual²/variance from `start`, the variances those of the solution (two
/// rounds: they hang on it weakly). A pose of weight 0 takes no part. Every pose's covariance must
/// be positive definite.
/// Errors: those of fit::fit_least_squares. Cost: O(poses) an iteration.
[[nodiscard]] Result<NormFit> fit_norm(View<NormalisedPose> poses,
                                       View<double> weights,
                                       NormParameters free,
                                       const Parameters& start);

/// The same with Cauchy's loss, whose weights are 1/(1 + (r/2.385 s)²), s from the median of |r|.
/// One bad pose in twelve does it no harm; from one in eight on they can pull it, all one way and
/// far off the sooner. Returns the weights to begin an ordinary fit with:
/// 0 for those beyond 6 s, else 1.
/// Source: P. W. Holland, R. E. Welsch, Robust regression using iteratively reweighted
/// least-squares, Communications in Statistics A6 (1977) 813.
struct RobustStart {
  Parameters p;
  std::vector<double> weights;
};
[[nodiscard]] RobustStart robust_start(View<NormalisedPose> poses,
                                       NormParameters free,
                                       const Parameters& start);

}  // namespace proofmass::calibrate
