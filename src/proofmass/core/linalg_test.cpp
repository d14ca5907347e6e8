#include "proofmass/core/linalg.hpp"

#include <gtest/gtest.h>

namespace proofmass {
namespace {

TEST(SymmetricEigen, RebuildsTheMatrixWithValuesAscending) {
  Eigen::MatrixXd A(3, 3);
  A << 4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 5.0;
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_TRUE(
      (eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose()).isApprox(A, 1e-12));
  EXPECT_LE(eigen.values(0), eigen.values(1));
  EXPECT_LE(eigen.values(1), eigen.values(2));
}

}  // namespace
}  // namespace proofmass
