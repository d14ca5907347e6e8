#include "proofmass/fit/objective.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/fit/differences.hpp"

namespace proofmass::fit {
namespace {

Eigen::VectorXd vector_or(const std::vector<double>& given, std::size_t size, double otherwise) {
  if (given.empty()) return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(size), otherwise);
  return Eigen::VectorXd::Map(given.data(), static_cast<Eigen::Index>(given.size()));
}

std::span<double> span_of(Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

View<double> view_of(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

}  // namespace

Objective::Objective(const LeastSquaresProblem& problem, const LeastSquaresOptions& options)
    : problem_(problem),
      residual_count_(static_cast<Eigen::Index>(problem.residual_count)),
      lower_(
          vector_or(problem.lower, problem.start.size(), -std::numeric_limits<double>::infinity())),
      upper_(
          vector_or(problem.upper, problem.start.size(), std::numeric_limits<double>::infinity())) {
  const Eigen::VectorXd start = vector_or(problem.start, 0, 0.0);
  scale_ =
      options.scale.empty() ? Eigen::VectorXd(start.cwiseAbs()) : vector_or(options.scale, 0, 0.0);
  for (double& scale : scale_)
    if (scale == 0.0) scale = 1.0;
}

bool Objective::residuals(const Eigen::VectorXd& p, Eigen::VectorXd& r) const {
  r.resize(residual_count_);
  problem_.residuals(view_of(p), span_of(r));
  // A sum of squares that overflows is treated as an infinite residual.
  return std::isfinite(r.squaredNorm());
}

Eigen::MatrixXd Objective::jacobian(const Eigen::VectorXd& p) const {
  Eigen::MatrixXd J(residual_count_, parameters());
  if (problem_.jacobian) {
    problem_.jacobian(view_of(p), J);
    if (J.allFinite()) return J;
  }
  Eigen::VectorXd moved = p;
  for (Eigen::Index j = 0; j < parameters(); ++j) {
    if (lower_(j) == upper_(j)) {
      J.col(j).setZero();
      continue;
    }
    // The magnitude of a parameter is its natural scale, until it comes close to zero.
    const double scale = std::max(std::abs(p(j)), 1e-4 * scale_(j));
    J.col(j) = derivative(
        [&](double t, Eigen::VectorXd& r) {
          moved(j) = t;
          return residuals(moved, r);
        },
        p(j), {.scale = scale, .lower = lower_(j), .upper = upper_(j)}, residual_count_);
    moved(j) = p(j);
  }
  return J;
}

}  // namespace proofmass::fit
