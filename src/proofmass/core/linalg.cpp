#include "proofmass/core/linalg.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass {
namespace {

using Index = Eigen::Index;

// A and b scaled to a unit diagonal, so that one tolerance suits all unknowns.
struct ScaledProblem {
  Eigen::MatrixXd A;
  Eigen::VectorXd b, scale;
};

ScaledProblem scaled(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  ScaledProblem problem{A, b, A.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()};
  problem.A = problem.scale.asDiagonal() * A * problem.scale.asDiagonal();
  problem.A.diagonal().array() += 1e-14;
  problem.b = problem.scale.asDiagonal() * b;
  return problem;
}

// The minimiser with all unknowns zero except those listed.
Eigen::VectorXd solved_on(const ScaledProblem& problem, const std::vector<Index>& free) {
  const auto n = static_cast<Index>(free.size());
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd b(n);
  for (Index i = 0; i < n; ++i) {
    b(i) = problem.b(free[static_cast<std::size_t>(i)]);
    for (Index j = 0; j < n; ++j)
      A(i, j) = problem.A(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd part = A.llt().solve(b);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.b.size());
  for (Index i = 0; i < n; ++i) x(free[static_cast<std::size_t>(i)]) = part(i);
  return x;
}

// Fraction of the step from x to `to` until the first unknown reaches zero, 1 if none does.
double feasible_step(const Eigen::VectorXd& x,
                     const Eigen::VectorXd& to,
                     const std::vector<Index>& free) {
  double step = 1.0;
  for (const Index i : free) {
    if (to(i) <= 0.0 && x(i) > to(i)) step = std::min(step, x(i) / (x(i) - to(i)));
  }
  return step;
}

// Moves x to the minimiser over the free unknowns; those that would become negative stop at zero
// and are no longer free.
void settle(const ScaledProblem& problem, Eigen::VectorXd& x, std::vector<Index>& free) {
  while (!free.empty()) {
    const Eigen::VectorXd to = solved_on(problem, free);
    const double step = feasible_step(x, to, free);
    x += step * (to - x);
    if (step >= 1.0) return;
    std::erase_if(free, [&](Index i) { return x(i) <= 1e-15 * x.maxCoeff() && to(i) <= 0.0; });
    Eigen::VectorXd kept = Eigen::VectorXd::Zero(x.size());
    for (const Index i : free) kept(i) = x(i);
    x = kept;
  }
}

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A) {
  PM_EXPECTS(A.rows() == A.cols() && A.allFinite());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd non_negative_minimiser(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  PM_EXPECTS(A.rows() == A.cols() && A.rows() == b.size());
  const ScaledProblem problem = scaled(A, b);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  std::vector<Index> free;
  for (Index rounds = 0; rounds < 3 * b.size() + 3; ++rounds) {
    Eigen::VectorXd downhill = problem.b - problem.A * x;
    for (const Index i : free) downhill(i) = 0.0;
    Index best = 0;
    if (downhill.maxCoeff(&best) <= 1e-12 * problem.b.cwiseAbs().maxCoeff()) break;
    free.push_back(best);
    settle(problem, x, free);
  }
  return problem.scale.asDiagonal() * x;
}

PositiveFactor::PositiveFactor(const Eigen::MatrixXd& A) {
  PM_EXPECTS(A.rows() == A.cols());
  ScaledProblem problem = scaled(A, Eigen::VectorXd::Zero(A.rows()));
  L_ = Eigen::LLT<Eigen::MatrixXd>(problem.A).matrixLLT();
  scale_ = std::move(problem.scale);
}

Eigen::VectorXd PositiveFactor::solve(const Eigen::VectorXd& b) const {
  const auto L = L_.triangularView<Eigen::Lower>();
  return scale_.cwiseProduct(L.transpose().solve(L.solve(scale_.cwiseProduct(b))));
}

Eigen::VectorXd PositiveFactor::quadratic_forms(const Eigen::MatrixXd& X) const {
  Eigen::MatrixXd columns = scale_.asDiagonal() * X.transpose();
  L_.triangularView<Eigen::Lower>().solveInPlace(columns);
  return columns.colwise().squaredNorm();
}

double PositiveFactor::log_determinant() const {
  return 2.0 * L_.diagonal().array().log().sum() - 2.0 * scale_.array().log().sum();
}

Eigen::MatrixXd PositiveFactor::inverse() const {
  const auto L = L_.triangularView<Eigen::Lower>();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(L_.rows(), L_.cols());
  L.solveInPlace(inverse);
  L.transpose().solveInPlace(inverse);
  return scale_.asDiagonal() * inverse * scale_.asDiagonal();
}

Eigen::MatrixXd weighted_gram(const Eigen::MatrixXd& X, const Eigen::VectorXd& w) {
  const Eigen::MatrixXd rows = w.cwiseSqrt().asDiagonal() * X;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(X.cols(), X.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  return gram.selfadjointView<Eigen::Lower>();
}

PositiveInverse invert_positive(const Eigen::MatrixXd& A) {
  const PositiveFactor factor(A);
  return {factor.inverse(), factor.log_determinant()};
}

Eigen::MatrixXd positive_inverse(const Eigen::MatrixXd& A) {
  return invert_positive(A).inverse;
}

Eigen::MatrixXd solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  PM_EXPECTS(A.rows() == A.cols() && A.rows() == B.rows());
  return Eigen::PartialPivLU<Eigen::MatrixXd>(A).solve(B);
}

PositiveQr positive_qr(const Eigen::Matrix3d& A) {
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr(A);
  PositiveQr out{qr.householderQ(), qr.matrixQR().triangularView<Eigen::Upper>()};
  const Eigen::Vector3d sign = out.U.diagonal().cwiseSign();
  out.Q = out.Q * sign.asDiagonal();
  out.U = sign.asDiagonal() * out.U;
  return out;
}

}  // namespace proofmass
