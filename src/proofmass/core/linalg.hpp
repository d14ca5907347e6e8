#pragma once

#include <Eigen/Core>

// Dense solvers, compiled once here so that nobody else pays for Eigen's decompositions.
namespace proofmass {

/// A = V diag(values) Vᵀ of a symmetric matrix, values ascending, V orthonormal.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Reads the lower triangle of A, which must be square and finite. Cost: O(n³).
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

}  // namespace proofmass
