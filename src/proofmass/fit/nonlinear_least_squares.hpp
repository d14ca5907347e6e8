#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::fit {

/// Fills in r(p); NaN where the model is not defined, which only turns a step back.
using Residuals = std::function<void(View<double> parameters, std::span<double> residuals)>;

/// Fills in ∂r/∂p, one row a residual.
using Jacobian = std::function<void(View<double> parameters, Eigen::Ref<Eigen::MatrixXd> jacobian)>;

struct LeastSquaresProblem {
  Residuals residuals;
  std::size_t residual_count;
  std::vector<double> start;
  std::vector<double> lower = {};  ///< empty: no bounds; −∞ where one parameter has none
  std::vector<double> upper = {};  ///< equal to lower: the parameter is held
  Jacobian jacobian = {};          ///< empty: by differences, good to about 11 digits
};

struct LeastSquaresOptions {
  bool unit_variance = false;  ///< residuals are in units of their known standard deviation
  bool search_again = true;    ///< other ways downhill where the first ends in doubt
  int max_iterations = 5000;   ///< of each way downhill
  /// Size of a natural change of each parameter, for the differences; empty: |start|.
  std::vector<double> scale = {};
};

struct LeastSquaresFit {
  std::vector<double> parameters;
  Eigen::MatrixXd covariance;  ///< of the parameters
  std::vector<double> std;     ///< square roots of its diagonal
  double rss;                  ///< residual sum of squares
  double residual_std;         ///< √(rss/dof), NaN if dof is 0
  std::size_t dof;             ///< residuals less parameters that are not held
  int iterations;              ///< of all ways that were tried
  bool converged;              ///< the gradient is zero, to the rounding of the residuals
  std::vector<bool> at_bound;  ///< the minimum presses against a bound, or the parameter is held
  double condition;            ///< of the Jacobian, columns brought to unit length; ∞ if singular
};

/// The p between lower and upper that minimises ½ |r(p)|², the one of the basin that the start
/// lies in. The trust region is Levenberg and Marquardt's, in parameters scaled to the lengths of
/// the Jacobian's columns; parameters at a bound that the descent presses against are held; the
/// last steps are Gauss and Newton's, so that the sum of squares' own rounding does not limit p.
/// Where that ends without convergence or with a Jacobian that is nearly singular, it is tried
/// again with the parameters in which r is linear (found by trying) following the others, then with
/// other trust regions (shorter first steps, dogleg); the lowest minimum is kept.
///
///     covariance = s² (JᵀJ)⁻¹,   s² = rss/dof, or 1 with unit_variance
///
/// A parameter at its bound counts as known: its row and column are zero. One that the
/// residuals do not determine has an infinite variance.
///
/// Source: J. J. Moré, The Levenberg–Marquardt Algorithm (1978); D. M. Bates, D. G. Watts,
/// Nonlinear Regression Analysis (1988), section 2.2, and their relative offset for `converged`.
///
/// Errors: invalid_argument (sizes, bounds, no parameter, a start outside its bounds),
/// too_few_samples (fewer residuals than parameters), not_finite (start, or residuals there).
/// Cost: O(n p²) an iteration, and 8 to 20 calls for each column of a Jacobian by differences.
[[nodiscard]] Result<LeastSquaresFit> fit_least_squares(const LeastSquaresProblem& problem,
                                                        const LeastSquaresOptions& options = {});

}  // namespace proofmass::fit
