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
  std::size_t used = 0;
  double rss = 0.0;  ///< rᵀWr of those used: Σ residual²/variance where they are independent
  double condition = 0.0;
  int iterations = 0;
  bool converged = false;

  [[nodiscard]] std::size_t dof() const {
    const auto free = static_cast<std::size_t>(cofactor.rows());
    return used > free ? used - free : 0;
  }
};

/// Least rᵀWr over the poses for which `used` holds, from `start`, W of residual_weights() at the
/// solution (two rounds: it depends on it weakly). Every pose's covariance must be positive
/// definite. Errors: those of fit::fit_least_squares. Cost: O(poses) an iteration, and O(poses³) a
/// round where they are not independent.
[[nodiscard]] Result<NormFit> fit_norm(const NormData& data,
                                       const std::vector<bool>& used,
                                       NormParameters free,
                                       const Parameters& start);

/// What a fit that is there already says of every pose at other parameters.
[[nodiscard]] std::vector<NormTerm> terms_of(View<NormalisedPose> poses, const Parameters& p);

/// The same with Cauchy's loss, whose weights are 1/(1 + (r/2.385 s)²), s from the median of |r|.
/// One bad pose in twelve does it no harm; from one in eight on they can pull it, all one way and
/// far off the sooner. `kept` are those within 6 s.
/// Source: P. W. Holland, R. E. Welsch, Robust regression using iteratively reweighted
/// least-squares, Communications in Statistics A6 (1977) 813.
struct RobustStart {
  Parameters p;
  std::vector<bool> kept;
};
[[nodiscard]] RobustStart robust_start(View<NormalisedPose> poses,
                                       NormParameters free,
                                       const Parameters& start);

/// Which `keep` poses lie closest to a fit to them alone: the least sum of so many Σ
/// residual²/variance that descents from 60 subsets of as many poses as parameters find. The
/// subsets are the same every time. Source: P. J. Rousseeuw, K. Van Driessen, Data Mining and
/// Knowledge Discovery 12 (2006) 29.
[[nodiscard]] std::vector<bool> least_trimmed(View<NormalisedPose> poses,
                                              NormParameters free,
                                              const Parameters& start,
                                              std::size_t keep);

}  // namespace proofmass::calibrate
