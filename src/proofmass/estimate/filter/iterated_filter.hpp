#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "proofmass/estimate/filter/iteration.hpp"

// Iterated extended filter, for measurements that are nonlinear within the state's uncertainty.
namespace proofmass::estimate {

namespace detail {

/// Negative log posterior of a state at epoch k given its prediction and the measurements, −2 ln p
/// + constant.
template <StateSpaceModel Model>
[[nodiscard]] double unlikeliness(const Model& model,
                                  std::size_t k,
                                  const Gaussian<Model::states>& predicted,
                                  const Mat<Model::states>& x) {
  return squared_distance<Model::states>(predicted.cov, x - predicted.mean) + misfit(model, x, k);
}

}  // namespace detail

/// advance() with the measurements relinearised about the updated state until convergence: the most
/// probable state given the prediction, by
///
///     x⁽ⁱ⁺¹⁾ = x⁻ + K⁽ⁱ⁾ (z − h(x⁽ⁱ⁾) − H⁽ⁱ⁾ (x⁻ − x⁽ⁱ⁾)),   H⁽ⁱ⁾ = ∂h/∂x at x⁽ⁱ⁾.
///
/// - A step that leads to a less probable state is halved.
/// - Without convergence the epoch falls back to the plain extended filter, and the result reports
///   it.
/// - With a gate, steps are not halved: the gate selects measurements anew in each iteration.
///
/// Source: B. M. Bell, F. W. Cathey, IEEE Trans. Automatic Control 38 (1993) 294. Cost: an
/// advance() for each iteration.
template <StateSpaceModel Model>
Iterated advance_iterated(const Model& model,
                          std::size_t k,
                          const Gate& gate,
                          FilterState<Model::states>& state,
                          StepOf<Model>& step,
                          const IterateOptions& options = {}) {
  constexpr int N = Model::states;
  const FilterState<N> before = state;
  advance(detail::ReadAbout<Model>{model, nullptr}, k, gate, state, step);
  const Gaussian<N> predicted = state.x;
  const bool damped = std::isinf(gate.huber) && std::isinf(gate.limit);

  Iterated result;
  Mat<N> at = predicted.mean;
  double least = detail::unlikeliness(model, k, predicted, at);
  while (result.iterations < options.iterations && !result.converged) {
    state = before;
    advance(detail::ReadAbout<Model>{model, &at}, k, gate, state, step);
    ++result.iterations;
    result.change = detail::largest_change(at, state.x);
    result.converged = result.change <= options.tolerance;
    if (result.converged) break;
    const Mat<N> move = state.x.mean - at;
    double share = 1.0;
    double now = detail::unlikeliness(model, k, predicted, Mat<N>(at + move));
    while (damped && !(now <= least) && share > 1e-3) {
      share *= 0.5;
      now = detail::unlikeliness(model, k, predicted, Mat<N>(at + share * move));
    }
    at += share * move;
    least = now;
  }
  if (!result.converged && options.iterations != 1) {
    state = before;
    advance(model, k, gate, state, step);
  }
  return result;
}

/// Summary of a run of the iterated filter.
struct IteratedFilter {
  std::size_t unconverged = 0;  ///< epochs that fell back to the plain extended filter
  int most_iterations = 0;
};

/// filter() by advance_iterated().
template <StateSpaceModel Model, class Visit>
IteratedFilter filter_iterated(const Model& model,
                               const Gate& gate,
                               FilterState<Model::states>& state,
                               Visit&& visit,
                               const IterateOptions& options = {}) {
  IteratedFilter result;
  StepOf<Model> step;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const Iterated at = advance_iterated(model, k, gate, state, step, options);
    if (!at.converged) ++result.unconverged;
    result.most_iterations = std::max(result.most_iterations, at.iterations);
    visit(k, std::as_const(step));
  }
  return result;
}

}  // namespace proofmass::estimate
