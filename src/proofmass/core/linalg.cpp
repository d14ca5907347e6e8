#include "proofmass/core/linalg.hpp"

#include <Eigen/Eigenvalues>

#include "proofmass/core/contract.hpp"

namespace proofmass {

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  PM_EXPECTS(A.rows() == A.cols() && A.allFinite());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace proofmass
