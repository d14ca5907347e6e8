#include "proofmass/core/linalg.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace proofmass::linalg_test {
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

// Karush–Kuhn–Tucker conditions: no unknown can move and lower the function.
TEST(NonNegativeMinimiser, MeetsItsConditionsWhateverTheProblem) {
  std::mt19937_64 rng(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    Eigen::MatrixXd X(12, 5);
    for (auto& value : X.reshaped()) value = normal(rng);
    // Unknowns of very different magnitude, as the terms of a spectrum have.
    for (int j = 0; j < 5; ++j) X.col(j) *= std::pow(10.0, 4 * j - 8);
    Eigen::VectorXd y(12);
    for (auto& value : y) value = normal(rng);
    const Eigen::MatrixXd A = X.transpose() * X;
    const Eigen::VectorXd b = X.transpose() * y;
    const Eigen::VectorXd x = non_negative_minimiser(A, b);
    const Eigen::VectorXd uphill = A * x - b;
    for (int i = 0; i < 5; ++i) {
      const double unit = std::sqrt(A(i, i));
      EXPECT_GE(x(i), 0.0);
      EXPECT_GE(uphill(i) / unit, -1e-9);
      if (x(i) > 0.0) {
        EXPECT_NEAR(uphill(i) / unit, 0.0, 1e-9);
      }
    }
  }
}

TEST(PositiveInverse, UndoesTheMatrix) {
  Eigen::MatrixXd A(2, 2);
  A << 4.0e3, 1.0, 1.0, 3.0e-3;
  EXPECT_TRUE((A * positive_inverse(A)).isApprox(Eigen::MatrixXd::Identity(2, 2), 1e-9));
}

TEST(PositiveInverse, KnowsTheLogarithmOfTheDeterminant) {
  // |A| of the n × n matrix with 2 on its diagonal and −1 next to it is n + 1.
  for (const int n : {1, 2, 7, 40}) {
    Eigen::MatrixXd A = 2.0 * Eigen::MatrixXd::Identity(n, n);
    for (int k = 1; k < n; ++k) A(k, k - 1) = A(k - 1, k) = -1.0;
    const PositiveInverse found = invert_positive(A);
    EXPECT_NEAR(found.log_determinant, std::log(n + 1.0), 1e-10);
    EXPECT_TRUE((A * found.inverse).isApprox(Eigen::MatrixXd::Identity(n, n), 1e-9));
  }
}

TEST(PositiveInverse, KnowsADeterminantThatNoDoubleHolds) {
  const Eigen::VectorXd d = Eigen::VectorXd::LinSpaced(60, -30.0, 29.0);
  const Eigen::MatrixXd A =
      d.unaryExpr([](double power) { return std::pow(10.0, 10.0 * power); }).asDiagonal();
  EXPECT_NEAR(invert_positive(A).log_determinant, 10.0 * d.sum() * std::log(10.0), 1e-9);
}

// Against LU, which shares nothing with the factor, for columns of very different scales.
TEST(PositiveFactor, SolvesAsLuDoes) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd X(20, 6);
  for (double& x : X.reshaped()) x = normal(random);
  X.col(2) *= 1e4;
  const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(20, 0.0, 3.0);
  const Eigen::MatrixXd gram = X.transpose() * w.asDiagonal() * X;
  EXPECT_LT((weighted_gram(X, w) - gram).cwiseAbs().maxCoeff(), 1e-14 * gram.maxCoeff());
  const PositiveFactor factor(gram);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(6, -1.0, 2.0);
  EXPECT_LT((gram * factor.solve(b) - b).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::MatrixXd solved = solve(gram, X.transpose());
  const Eigen::VectorXd forms = factor.quadratic_forms(X);
  for (Eigen::Index k = 0; k < X.rows(); ++k)
    EXPECT_NEAR(forms(k), X.row(k).dot(solved.col(k)), 1e-10) << k;
}

}  // namespace
}  // namespace proofmass::linalg_test
