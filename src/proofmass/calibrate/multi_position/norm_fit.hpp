#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::calibrate {

/// Which of the nine parameters are free: the first six, with orthogonal axes, or all.
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

/// Minimises rᵀWr over the poses for which `used` holds, from `start`, with W of residual_weights()
/// at the solution (two rounds: it depends on it weakly). Every pose's covariance must be positive
/// definite. Errors: those of fit::fit_least_squares. Cost: O(poses) an iteration, and O(poses³) a
/// round if they are not independent.
[[nodiscard]] Result<NormFit> fit_norm(const NormData& data,
                                       const std::vector<bool>& used,
                                       NormParameters free,
                                       const Parameters& start);

/// Gauss–Newton steps with fixed weights W of the residuals, from a start close to the minimum; all
/// poses are used. nullopt if the steps do not converge. Cost: O(poses) a step, O(poses²) with a
/// dense W; some three or four steps.
[[nodiscard]] std::optional<Parameters> refit_norm(View<NormalisedPose> poses,
                                                   const ResidualWeights& W,
                                                   NormParameters free,
                                                   const Parameters& start);

/// The terms of every pose at other parameters.
[[nodiscard]] std::vector<NormTerm> terms_of(View<NormalisedPose> poses, const Parameters& p);

/// Fit with Cauchy's loss, whose weights are 1/(1 + (r/2.385 s)²), s from the median of |r|. It
/// tolerates one bad pose in twelve; from one in eight on they can bias it, most easily if all are
/// far off in one direction. `kept` are those within 6 s. Source: P. W. Holland, R. E. Welsch,
/// Robust regression using iteratively reweighted least-squares, Communications in Statistics A6
/// (1977) 813.
struct RobustStart {
  Parameters p;
  std::vector<bool> kept;
};
[[nodiscard]] RobustStart robust_start(View<NormalisedPose> poses,
                                       NormParameters free,
                                       const Parameters& start);

/// Least trimmed squares: the `keep` poses with the smallest Σ residual²/variance about a fit to
/// them alone, found by descents from 60 minimal subsets. The subsets are deterministic. Source: P.
/// J. Rousseeuw, K. Van Driessen, Data Mining and Knowledge Discovery 12 (2006) 29.
[[nodiscard]] std::vector<bool> least_trimmed(View<NormalisedPose> poses,
                                              NormParameters free,
                                              const Parameters& start,
                                              std::size_t keep);

}  // namespace proofmass::calibrate
