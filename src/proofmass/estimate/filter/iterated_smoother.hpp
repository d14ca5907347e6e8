#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "proofmass/estimate/filter/iteration.hpp"

// Iterated extended smoother: the most probable trajectory of a nonlinear model.
namespace proofmass::estimate {

/// Negative log probability density of a path given every measurement, up to a constant:
///
///     ½ |x[0] − m|²_P + ½ Σ |x[k] − f(x[k−1])|²_Q + ½ Σ (z − h(x[k]))² / R.
///
/// If Q or P is singular, only its range counts. `path` has a state for each epoch.
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

/// Every state given every measurement, and how the iteration ended.
template <int N>
struct IteratedPath {
  std::vector<Gaussian<N>> states;  ///< the path, with the covariances of the last linearisation
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
      [&](std::size_t k, const auto& step, const BackwardInformation<Model::states>& later) {
        out[k] = {later.mean(step.filtered), later.template cov<Model::states>(step.filtered)};
      });
}

/// Moves from `path` towards `to`, halving the step until the objective does not rise.
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

/// The extended smoother, repeated with motion and measurements relinearised about the previous
/// path: the Gauss–Newton method for the path of highest posterior density.
///
/// - Each step is one linear smoother, halved if it leads to a less probable path.
/// - `iterations` counts smoothers; the first is the plain extended one.
/// - If `how.converged` is false, the path is the best found.
/// - With a gate, steps are not halved: the gate selects measurements anew in each iteration.
///
/// Source: B. M. Bell, SIAM J. Optimization 4 (1994) 626; S. Särkkä, Bayesian Filtering and
/// Smoothing (2013), section 9.1, for the extended smoother. Cost: a smoother for each iteration;
/// memory O(epochs).
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
