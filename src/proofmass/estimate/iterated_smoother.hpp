#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/estimate/relinearised.hpp"

// Iterated extended smoother: the most probable path of a model that is not linear.
namespace proofmass::estimate {

/// The negative logarithm of a path's probability density given every reading, up to a constant:
///
///     ½ |x[0] − m|²_P + ½ Σ |x[k] − f(x[k−1])|²_Q + ½ Σ (z − h(x[k]))² / R.
///
/// Where Q or P has no inverse its range alone is counted. `path` has a state for each instant.
template <StateSpaceModel Model>
[[nodiscard]] double objective(const Model& model,
                               const Gaussian<Model::states>& prior,
                               const std::vector<Mat<Model::states>>& path) {
  constexpr int N = Model::states, D = Model::moving;
  double twice = 0.0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    twice += detail::misfit(model, path[k], k);
    if (k == 0) {
      twice += detail::squared_distance<N>(prior.cov, path[0] - prior.mean);
      continue;
    }
    const Transition<N, D> step = model.transition(path[k - 1], k);
    twice += detail::squared_distance<D>(step.Q, path[k].template head<D>() - step.mean);
    for (int i = D; i < N; ++i)
      if (step.walk(i) > 0.0)
        twice += (path[k](i) - path[k - 1](i)) * (path[k](i) - path[k - 1](i)) / step.walk(i);
  }
  return 0.5 * twice;
}

/// Every state given every reading, and how that was found.
template <int N>
struct IteratedPath {
  std::vector<Gaussian<N>> states;  ///< the path, with the covariances of the last linear model
  Iterated how;
  double objective = 0.0;  ///< of the path, see objective()
};

namespace detail {

template <StateSpaceModel Model>
void smooth_into(const Model& model,
                 const FilterState<Model::states>& prior,
                 const Gate& gate,
                 std::vector<Gaussian<Model::states>>& out) {
  smooth(
      model, prior, gate, [](std::size_t, const auto&) {},
      [&](std::size_t k, const auto& step, const Hindsight<Model::states>& later) {
        out[k] = {later.mean(step.filtered), later.template cov<Model::states>(step.filtered)};
      });
}

/// Goes from `path` towards `to` as far as the objective does not rise, a power of a half.
template <StateSpaceModel Model>
double go_towards(const Model& model,
                  const Gaussian<Model::states>& prior,
                  const std::vector<Gaussian<Model::states>>& to,
                  double least,
                  std::vector<Mat<Model::states>>& path) {
  const std::vector<Mat<Model::states>> from = path;
  double share = 1.0, now = 0.0;
  for (;; share *= 0.5) {
    for (std::size_t k = 0; k < path.size(); ++k)
      path[k] = from[k] + share * (to[k].mean - from[k]);
    now = objective(model, prior, path);
    if (now <= least || share < 1e-3) return now;
  }
}

}  // namespace detail

/// The extended smoother, then again and again with motion and readings made linear about the path
/// before: Gauss and Newton's method for the path of the highest posterior density, each step one
/// linear smoother, halved where it leads to a less probable path. `iterations` counts smoothers;
/// the first is the plain extended one. Where `how.converged` is false the path is the best found.
/// With a gate steps are not halved: what it lets through is chosen anew each time.
/// Source: B. M. Bell, SIAM J. Optimization 4 (1994) 626; S. Särkkä, Bayesian Filtering and
/// Smoothing (2013), section 9.1, for the extended smoother. Cost: a smoother for each iteration;
/// memory O(instants).
template <StateSpaceModel Model>
[[nodiscard]] IteratedPath<Model::states> smooth_iterated(const Model& model,
                                                          const FilterState<Model::states>& prior,
                                                          const Gate& gate = {},
                                                          const IterateOptions& options = {}) {
  constexpr int N = Model::states;
  const bool damped = std::isinf(gate.huber) && std::isinf(gate.limit);
  IteratedPath<N> result;
  result.states.resize(model.size());
  detail::smooth_into(model, prior, gate, result.states);
  std::vector<Mat<N>> path(model.size());
  for (std::size_t k = 0; k < path.size(); ++k) path[k] = result.states[k].mean;
  result.objective = objective(model, prior.x, path);
  for (result.how.iterations = 1; result.how.iterations < options.iterations;) {
    detail::smooth_into(detail::LinearAbout<Model>{model, path.data()}, prior, gate, result.states);
    ++result.how.iterations;
    result.how.change = 0.0;
    for (std::size_t k = 0; k < path.size(); ++k)
      result.how.change =
          std::max(result.how.change, detail::largest_change(path[k], result.states[k]));
    result.how.converged = result.how.change <= options.tolerance;
    const double least = damped && !result.how.converged ? result.objective
                                                         : std::numeric_limits<double>::infinity();
    result.objective = detail::go_towards(model, prior.x, result.states, least, path);
    if (result.how.converged) break;
  }
  for (std::size_t k = 0; k < path.size(); ++k) result.states[k].mean = path[k];
  return result;
}

}  // namespace proofmass::estimate
