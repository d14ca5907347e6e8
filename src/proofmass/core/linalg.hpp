#pragma once

#include <Eigen/Core>

// Dense solvers, compiled once here so that other translation units need not instantiate Eigen's
// decompositions.
namespace proofmass {

/// A = V diag(values) Vᵀ of a symmetric matrix, values ascending, V orthonormal.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Reads the lower triangle of A, which must be square and finite. Cost: O(n³).
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// The x ≥ 0 that minimises ½ xᵀA x − bᵀx, for A symmetric positive definite: the normal equations
/// of non-negative least squares. If A is singular, one of the minimisers. Source: C. L. Lawson, R.
/// J. Hanson, Solving Least Squares Problems (1974), algorithm NNLS. Cost: O(n³) per step, few
/// steps.
[[nodiscard]] Eigen::VectorXd non_negative_minimiser(const Eigen::MatrixXd& A,
                                                     const Eigen::VectorXd& b);

/// Cholesky factor of a symmetric positive definite matrix, of a singular one with a ridge of 1e-14
/// of its diagonal: for what needs no inverse, which takes several times as long. Cost: O(n³/3).
class PositiveFactor {
 public:
  PositiveFactor() = default;
  explicit PositiveFactor(const Eigen::MatrixXd& A);

  /// A⁻¹ b.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

  /// xᵀ A⁻¹ x for each row x of X.
  [[nodiscard]] Eigen::VectorXd quadratic_forms(const Eigen::MatrixXd& X) const;

  [[nodiscard]] double log_determinant() const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::MatrixXd L_;      // of A scaled to a unit diagonal
  Eigen::VectorXd scale_;  // of rows and columns
};

/// Xᵀ diag(w) X, w ≥ 0.
[[nodiscard]] Eigen::MatrixXd weighted_gram(const Eigen::MatrixXd& X, const Eigen::VectorXd& w);

/// A⁻¹ and ln |A|.
struct PositiveInverse {
  Eigen::MatrixXd inverse;
  double log_determinant = 0.0;
};

/// Inverts a symmetric positive definite matrix; a singular one with a ridge of 1e-14 of its
/// diagonal. Cost: O(n³).
[[nodiscard]] PositiveInverse invert_positive(const Eigen::MatrixXd& A);

/// The inverse alone.
[[nodiscard]] Eigen::MatrixXd positive_inverse(const Eigen::MatrixXd& A);

/// The X of A X = B, by LU with partial pivoting; A square and regular. Cost: O(n³).
[[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// A = Q U with Q orthogonal and U upper triangular, the diagonal of U positive: unique for a
/// regular A.
struct PositiveQr {
  Eigen::Matrix3d Q, U;
};
[[nodiscard]] PositiveQr positive_qr(const Eigen::Matrix3d& A);

}  // namespace proofmass
