#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/fit/nonlinear_least_squares.hpp"

namespace proofmass::fit {

/// Columns A = Q R, orthonormalised once for all fits that share them.
struct FactoredColumns {
  Eigen::MatrixXd Q;                ///< n × rank
  Eigen::MatrixXd R_inverse;        ///< columns × rank: the coefficients of y are R⁻¹ Qᵀ y
  Eigen::MatrixXd inverse_product;  ///< (AᵀA)⁻¹ = R⁻¹ R⁻ᵀ
  Eigen::VectorXd length;           ///< length of each column of A
};

/// A column that depends linearly on the others, to 1e-12 of its length, is dropped: its row of R⁻¹
/// is zero. A must be finite. Cost: O(n m²).
[[nodiscard]] std::shared_ptr<const FactoredColumns> factor_columns(
    const Eigen::Ref<const Eigen::MatrixXd>& A);

/// Fills in the n × m columns of Φ that depend on α; NaN where they are undefined.
using Basis = std::function<void(View<double> alpha, Eigen::Ref<Eigen::MatrixXd> columns)>;

/// y ≈ Φ(α) c with Φ = [constant columns, varying columns]. To weight the rows, weight y and Φ.
struct SeparableProblem {
  Basis basis;                   ///< the varying columns
  Eigen::Index varying_columns;  ///< at least 1
  std::vector<double> start;     ///< α
  std::vector<double> lower = {};
  std::vector<double> upper = {};
  std::shared_ptr<const FactoredColumns> constant = {};  ///< empty: none
};

struct SeparableOptions {
  bool unit_variance = false;      ///< y and Φ are scaled to the known standard deviation of y
  bool search_again = false;       ///< as in LeastSquaresOptions
  int max_iterations = 200;        ///< a decay that is not in the data would not terminate
  std::vector<double> scale = {};  ///< natural scale of α, as in LeastSquaresOptions
};

struct SeparableFit {
  std::vector<double> alpha;
  Eigen::VectorXd coefficients;  ///< c: constant columns first
  Eigen::MatrixXd covariance;    ///< covariance of [α; c]
  double rss;
  double residual_std;  ///< √(rss/dof), NaN if dof is 0
  Eigen::Index dof;     ///< rows minus rank of Φ minus number of free α
  int iterations;
  bool converged;
  std::vector<bool> at_bound;  ///< for each α
  double condition;            ///< of α's Jacobian with Φ projected out, columns of unit length
  double basis_condition;      ///< |Φ| |Φ⁺| / columns in the Frobenius norm, columns of unit
                               ///< length: 1 if orthogonal, ∞ if rank deficient
};

/// Minimises ½ |y − Φ(α) c|² over α alone, since c = Φ⁺ y is known for each α:
///
///     r(α) = P y,   ∂r/∂α ≈ −P (∂Φ/∂α) c,   P = 1 − Φ Φ⁺
///
/// The constant columns are projected out once; the remainder of the varying ones is factored again
/// for each α. The covariance is that of the full nonlinear fit, with B = Φ⁺ (∂Φ/∂α) c:
///
///     cov α = s² (JᵀJ)⁻¹,   cov(α, c) = −cov α Bᵀ,   cov c = s² (ΦᵀΦ)⁻¹ + B cov α Bᵀ
///
/// If Φ is rank deficient, the dependent columns have coefficient 0 and an infinite variance.
///
/// Source: G. H. Golub, V. Pereyra, The Differentiation of Pseudo-Inverses and Nonlinear Least
/// Squares Problems Whose Variables Separate (1973); L. Kaufman, A Variable Projection Method for
/// Solving Separable Nonlinear Least Squares Problems (1975), for the Jacobian.
///
/// Errors: those of fit_least_squares; invalid_argument (y and the constant columns differ in
/// length), too_few_samples (fewer rows than columns and α), not_finite (y).
/// Cost: O(n m_constant m_varying) per evaluation, O(m³) at the end.
[[nodiscard]] Result<SeparableFit> fit_separable(View<double> y,
                                                 const SeparableProblem& problem,
                                                 const SeparableOptions& options = {});

}  // namespace proofmass::fit
