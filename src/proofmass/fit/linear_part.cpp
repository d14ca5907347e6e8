#include "proofmass/fit/linear_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/fit/tangent.hpp"

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;

constexpr double rounding = 1e-10;

// True if r is linear in p_j and p_k jointly: r(+j) + r(+k) = r + r(+j +k); with j = k, in p_j.
bool is_linear(const Objective& objective,
               const Eigen::VectorXd& at,
               const Eigen::VectorXd& unit,
               Index j,
               Index k) {
  Eigen::VectorXd p = at, r, r_j, r_k, r_jk;
  if (!objective.residuals(p, r)) return false;
  p(j) = at(j) + unit(j);
  if (!objective.residuals(p, r_j)) return false;
  p(k) += unit(k);
  if (!objective.residuals(p, r_jk)) return false;
  p(j) = at(j);
  p(k) = at(k) + unit(k);
  if (!objective.residuals(p, r_k)) return false;
  const double felt = std::min((r_j - r).norm(), (r_k - r).norm());
  const double largest = r.norm() + r_j.norm() + r_k.norm() + r_jk.norm();
  return felt > rounding * largest &&
         (r_j + r_k - r - r_jk).norm() < rounding * felt + 1e-14 * largest;
}

}  // namespace

LinearPart::LinearPart(const Objective& objective, const Eigen::VectorXd& at)
    : objective_(objective), unit_(at.cwiseAbs()) {
  for (Index j = 0; j < at.size(); ++j) {
    if (unit_(j) == 0.0) unit_(j) = 1.0;
    const bool bounded = std::isfinite(objective.lower()(j)) || std::isfinite(objective.upper()(j));
    bool linear = !bounded && is_linear(objective, at, unit_, j, j);
    for (const Index k : linear_) linear = linear && is_linear(objective, at, unit_, j, k);
    (linear ? linear_ : others_).push_back(j);
  }
}

Eigen::VectorXd LinearPart::completed(Eigen::VectorXd p) const {
  Eigen::VectorXd begin = p;
  begin(linear_).setZero();
  Eigen::VectorXd r, r_moved;
  if (!objective_.residuals(begin, r)) return p;
  Eigen::MatrixXd A(r.size(), static_cast<Index>(linear_.size()));
  for (std::size_t k = 0; k < linear_.size(); ++k) {
    Eigen::VectorXd moved = begin;
    moved(linear_[k]) = unit_(linear_[k]);
    if (!objective_.residuals(moved, r_moved)) return p;
    A.col(static_cast<Index>(k)) = (r_moved - r) / unit_(linear_[k]);
  }
  const Eigen::VectorXd c = tangent_at(A, r).step;
  if (!c.allFinite()) return p;
  p(linear_) = c;
  return p;
}

LeastSquaresProblem LinearPart::reduced_problem(const Eigen::VectorXd& start) const {
  LeastSquaresProblem problem{
      .residuals = {},
      .residual_count = static_cast<std::size_t>(objective_.residual_count()),
      .start = {}};
  for (const Index j : others_) {
    problem.start.push_back(start(j));
    problem.lower.push_back(objective_.lower()(j));
    problem.upper.push_back(objective_.upper()(j));
  }
  problem.residuals = [this, start](View<double> others, std::span<double> residuals) {
    Eigen::VectorXd p = start, r;
    p(others_) = Eigen::VectorXd::Map(others.data(), static_cast<Index>(others.size()));
    if (!objective_.residuals(completed(p), r))
      r.setConstant(std::numeric_limits<double>::quiet_NaN());
    std::ranges::copy(r, residuals.begin());
  };
  return problem;
}

}  // namespace proofmass::fit
