#include "proofmass/fit/minimum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/fit/descent.hpp"
#include "proofmass/fit/linear_part.hpp"

namespace proofmass::fit {
namespace {

using Index = Eigen::Index;

// True if the parameter is fixed, or at a bound that the descent presses against.
bool is_held(const Objective& objective, const Eigen::VectorXd& p, Index j, double gradient) {
  const double lower = objective.lower()(j), upper = objective.upper()(j);
  return lower == upper || (p(j) <= lower && gradient >= 0.0) || (p(j) >= upper && gradient <= 0.0);
}

// Updates all quantities that depend on p. False if the residuals are not finite.
bool look_around(const Objective& objective, Minimum& at) {
  if (!objective.residuals(at.p, at.r)) return false;
  at.rss = at.r.squaredNorm();
  const Eigen::MatrixXd J = objective.jacobian(at.p);
  const Eigen::VectorXd gradient = J.transpose() * at.r;
  at.free.clear();
  for (Index j = 0; j < at.p.size(); ++j)
    if (!is_held(objective, at.p, j, gradient(j))) at.free.push_back(j);
  at.tangent = tangent_at(J(Eigen::all, at.free), at.r);
  return true;
}

// True if the next Gauss–Newton step is negligible relative to the parameters, and relative to the
// residuals (Bates and Watts's relative offset).
bool is_stationary(const Minimum& at) {
  if (at.tangent.along <= 1e-6 * std::sqrt(at.rss)) return true;
  for (std::size_t k = 0; k < at.free.size(); ++k)
    if (std::abs(at.tangent.step(static_cast<Index>(k))) > 1e-9 * std::abs(at.p(at.free[k])))
      return false;
  return true;
}

// The sum of squares is flat to rounding long before the Gauss–Newton step is zero: steps continue
// while each is shorter than the last.
void polish(const Objective& objective, Minimum& at) {
  for (int k = 0; k < 200 && at.tangent.along > 0.0; ++k) {
    Minimum next = at;
    for (std::size_t i = 0; i < at.free.size(); ++i)
      next.p(at.free[i]) += at.tangent.step(static_cast<Index>(i));
    next.p = next.p.cwiseMax(objective.lower()).cwiseMin(objective.upper());
    if (!look_around(objective, next) || next.free != at.free) return;
    if (next.tangent.along > 0.9 * at.tangent.along || next.rss > at.rss * (1.0 + 1e-9)) return;
    ++next.iterations;
    at = std::move(next);
  }
}

// Descends by one method, rescaled at each end point, until there is no further improvement.
Minimum minimum_by(const Objective& objective, const Eigen::VectorXd& start, Descent descent) {
  Minimum at;
  at.p = start;
  if (!look_around(objective, at)) return at;
  const int most = descent.max_iterations;
  for (int round = 0; round < 20 && at.iterations < most; ++round) {
    Minimum next = at;
    descent.free = at.free;
    descent.max_iterations = most - at.iterations;
    next.iterations += descend(objective, descent, next.p);
    if (!look_around(objective, next)) break;
    const bool better = next.rss < at.rss * (1.0 - 1e-9), same = next.free == at.free;
    if (next.rss <= at.rss || !same) at = next;
    at.iterations = next.iterations;
    if (!better && same) break;
  }
  polish(objective, at);
  at.converged = is_stationary(at);
  return at;
}

// Keeps the lower of the two; if equal, the one that converged.
void keep_lower(Minimum& best, Minimum found) {
  const int iterations = best.iterations + found.iterations;
  const double advantage = (found.converged ? 1e-6 : 0.0) - (best.converged ? 1e-6 : 0.0);
  if (found.rss < best.rss * (1.0 + advantage)) best = std::move(found);
  best.iterations = iterations;
}

// Two terms of the same form, such as two exponentials, may have been exchanged: restores the order
// of the start if the sum of squares is the same.
void restore_order(const Objective& objective, const Eigen::VectorXd& start, Minimum& at) {
  for (Index i = 0; i < at.p.size(); ++i)
    for (Index j = i + 1; j < at.p.size(); ++j) {
      if ((at.p(i) - at.p(j)) * (start(i) - start(j)) >= 0.0) continue;
      Eigen::VectorXd p = at.p, r;
      std::swap(p(i), p(j));
      if ((p.array() < objective.lower().array() || p.array() > objective.upper().array()).any())
        continue;
      if (objective.residuals(p, r) && std::abs(r.squaredNorm() - at.rss) <= 1e-9 * at.rss)
        at.p = p;
    }
}

// The minimum over the nonlinear parameters with the linear ones at their optimum.
Minimum minimum_without_linear_part(const Objective& objective,
                                    const Eigen::VectorXd& start,
                                    const LeastSquaresOptions& options) {
  const LinearPart part(objective, start);
  Minimum best;
  if (part.linear().empty()) return best;
  if (part.others().empty())
    return minimum_by(objective, part.completed(start),
                      {.free = {}, .max_iterations = options.max_iterations});
  const LeastSquaresProblem reduced = part.reduced_problem(start);
  const Objective reduced_objective(reduced, {});
  const Eigen::VectorXd from = start(part.others());
  for (const Way way : {Way::cautious, Way::levenberg_marquardt, Way::dogleg}) {
    Minimum found = minimum_by(reduced_objective, from,
                               {.way = way, .free = {}, .max_iterations = options.max_iterations});
    if (!std::isfinite(found.rss)) break;
    const bool in_doubt = found.in_doubt();
    keep_lower(best, std::move(found));
    if (!in_doubt) break;
  }
  if (!std::isfinite(best.rss)) return best;
  restore_order(reduced_objective, from, best);
  Eigen::VectorXd p = start;
  p(part.others()) = best.p;
  Minimum all = minimum_by(objective, part.completed(p),
                           {.free = {}, .max_iterations = options.max_iterations});
  all.iterations += best.iterations;
  return all;
}

}  // namespace

Minimum lowest_minimum(const Objective& objective,
                       const Eigen::VectorXd& start,
                       const LeastSquaresOptions& options) {
  Minimum best;
  for (const Way way : all_ways) {
    keep_lower(best,
               minimum_by(objective, start,
                          {.way = way, .free = {}, .max_iterations = options.max_iterations}));
    if (!options.search_again || !best.in_doubt()) break;
    if (way == all_ways[0])
      keep_lower(best, minimum_without_linear_part(objective, start, options));
    if (!best.in_doubt()) break;
  }
  return best;
}

}  // namespace proofmass::fit
