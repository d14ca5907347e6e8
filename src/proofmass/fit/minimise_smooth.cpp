#include "proofmass/fit/minimise_smooth.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace proofmass::fit {
namespace {

constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();

struct Point {
  Eigen::VectorXd p, gradient;
  double value = 0.0;
  [[nodiscard]] bool is_finite() const { return std::isfinite(value) && gradient.allFinite(); }
};

Point evaluate(const SmoothFunction& function, const Eigen::VectorXd& p) {
  Point point{p, Eigen::VectorXd::Zero(p.size())};
  const auto size = static_cast<std::size_t>(p.size());
  point.value = function({p.data(), size}, {point.gradient.data(), size});
  return point;
}

// A step that satisfies the weak Wolfe conditions, by doubling and bisection; the best point found
// if rounding prevents that. Source: A. S. Lewis, M. L. Overton, Math. Program. 141 (2013) 135,
// algorithm 2.6.
Point search(const SmoothFunction& function, const Point& from, const Eigen::VectorXd& direction) {
  constexpr double enough = 1e-4, flat = 0.9;
  constexpr int most_trials = 40;
  const double slope = from.gradient.dot(direction);
  double shortest = 0.0, longest = std::numeric_limits<double>::infinity(), step = 1.0;
  Point best = from;
  for (int k = 0; k < most_trials; ++k) {
    Point tried = evaluate(function, from.p + step * direction);
    const bool lower = tried.is_finite() && tried.value <= from.value + enough * step * slope;
    const bool flattened = lower && tried.gradient.dot(direction) >= flat * slope;
    if (lower && tried.value <= best.value) best = std::move(tried);
    if (flattened) return best;
    (lower ? shortest : longest) = step;
    step = std::isfinite(longest) ? 0.5 * (shortest + longest) : 2.0 * step;
    if (-step * slope < rounding * std::abs(from.value)) break;
  }
  return best;
}

// The inverse Hessian after a step, by the Broyden–Fletcher–Goldfarb–Shanno formula.
void update(const Eigen::VectorXd& step,
            const Eigen::VectorXd& change,
            bool first,
            Eigen::MatrixXd& inverse) {
  const double along = step.dot(change);
  if (!(along > 1e-14 * step.norm() * change.norm())) return;
  if (first) inverse *= along / change.squaredNorm();
  const Eigen::VectorXd moved = inverse * change;
  const double twice = (1.0 + change.dot(moved) / along) / along;
  inverse += twice * step * step.transpose() -
             (moved * step.transpose() + step * moved.transpose()) / along;
}

// A descent direction, limited to where the local model is likely to hold.
Eigen::VectorXd direction_from(const Point& at, Eigen::MatrixXd& inverse, double longest_step) {
  Eigen::VectorXd direction = -(inverse * at.gradient);
  if (!(direction.dot(at.gradient) < 0.0)) {
    inverse.setIdentity();
    direction = -at.gradient;
  }
  const double length = direction.lpNorm<Eigen::Infinity>();
  if (length > longest_step) direction *= longest_step / length;
  return direction;
}

}  // namespace

Result<SmoothMinimum> minimise_smooth(const SmoothFunction& function,
                                      const std::vector<double>& start,
                                      const SmoothOptions& options) {
  if (start.empty()) return Error{Errc::invalid_argument, "no parameter to move"};
  const auto size = static_cast<Eigen::Index>(start.size());
  Point at = evaluate(function, Eigen::VectorXd::Map(start.data(), size));
  if (!at.is_finite())
    return Error{Errc::not_finite, "the function or its gradient at the start is not finite"};
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(size, size);
  SmoothMinimum out;
  const auto slope = [&] { return at.gradient.lpNorm<Eigen::Infinity>(); };
  while (slope() > options.gradient_tolerance && out.iterations < options.max_iterations) {
    const Eigen::VectorXd direction = direction_from(at, inverse, options.longest_step);
    if (-at.gradient.dot(direction) < rounding * std::abs(at.value)) {
      out.converged = true;
      break;
    }
    Point next = search(function, at, direction);
    ++out.iterations;
    const double gained = at.value - next.value;
    update(next.p - at.p, next.gradient - at.gradient, out.iterations == 1, inverse);
    at = std::move(next);
    if (gained <= rounding * std::abs(at.value)) {
      out.converged = true;
      break;
    }
  }
  out.gradient = slope();
  out.converged = out.converged || out.gradient <= options.gradient_tolerance;
  out.value = at.value;
  out.parameters.assign(at.p.data(), at.p.data() + size);
  return out;
}

}  // namespace proofmass::fit
