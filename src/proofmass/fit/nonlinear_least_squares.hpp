#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::fit {

/// Fills in r(p); NaN where the model is not defined: such a step is rejected.
using Residuals = std::function<void(View<double> parameters, std::span<double> residuals)>;

/// Fills in ∂r/∂p, one row per residual.
using Jacobian = std::function<void(View<double> parameters, Eigen::Ref<Eigen::MatrixXd> jacobian)>;

struct LeastSquaresProblem {
  Residuals residuals;
  std::size_t residual_count;
  std::vector<double> start;
  std::vector<double> lower = {};  ///< empty: no bounds; −∞ for a parameter without one
  std::vector<double> upper = {};  ///< equal to lower: the parameter is fixed
  Jacobian jacobian = {};          ///< empty: by differences, accurate to about 11 digits
};

struct LeastSquaresOptions {
  bool unit_variance = false;  ///< residuals are in units of their known standard deviation
  bool search_again = true;    ///< tries other descent methods if the first is in doubt
  int max_iterations = 5000;   ///< per descent
  /// Natural scale of each parameter, for the differences; empty: |start|.
  std::vector<double> scale = {};
};

struct LeastSquaresFit {
  std::vector<double> parameters;
  Eigen::MatrixXd covariance;  ///< covariance of the parameters
  std::vector<double> std;     ///< square roots of its diagonal
  double rss;                  ///< residual sum of squares
  double residual_std;         ///< √(rss/dof), NaN if dof is 0
  std::size_t dof;             ///< residuals minus free parameters
  int iterations;              ///< total of all descents tried
  bool converged;              ///< the gradient is zero to the rounding of the residuals
  std::vector<bool> at_bound;  ///< the minimum is at an active bound, or the parameter is fixed
  double condition;            ///< Jacobian's, columns scaled to unit length; ∞ if singular
};

/// The p between lower and upper that minimises ½ |r(p)|², in the basin of the start.
///
/// - Levenberg–Marquardt trust region, in parameters scaled to the lengths of the Jacobian's
///   columns. Parameters at an active bound are fixed. The last steps are Gauss–Newton steps, so
///   that the rounding of the sum of squares does not limit p.
/// - If that does not converge, or ends at a nearly singular Jacobian, it is repeated with the
///   parameters in which r is linear (found numerically) eliminated, then with other trust regions
///   (shorter first steps, dogleg). The lowest minimum is kept.
///
///     covariance = s² (JᵀJ)⁻¹,   s² = rss/dof, or 1 with unit_variance
///
/// A parameter at its bound counts as known: its row and column are zero. One that is not
/// identifiable from the residuals has an infinite variance.
///
/// Source: J. J. Moré, The Levenberg–Marquardt Algorithm (1978); D. M. Bates, D. G. Watts,
/// Nonlinear Regression Analysis (1988), section 2.2, and their relative offset for `converged`.
///
/// Errors: invalid_argument (sizes, bounds, no parameter, a start outside its bounds),
/// too_few_samples (fewer residuals than parameters), not_finite (start, or residuals there).
/// Cost: O(n p²) per iteration, and 8 to 20 calls for each column of a Jacobian by differences.
[[nodiscard]] Result<LeastSquaresFit> fit_least_squares(const LeastSquaresProblem& problem,
                                                        const LeastSquaresOptions& options = {});

}  // namespace proofmass::fit
