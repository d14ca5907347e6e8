#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "proofmass/estimate/relinearised.hpp"

// Iterated extended filter: where readings bend within what is known of the state.
namespace proofmass::estimate {

namespace detail {

/// How unlikely a state is at instant k given its prediction and the readings, −2 ln p + constant.
template <StateSpaceModel Model>
[[nodiscard]] double unlikeliness(const Model& model,
                                  std::size_t k,
                                  const Gaussian<Model::states>& predicted,
                                  const Mat<Model::states>& x) {
  return squared_distance<Model::states>(predicted.cov, x - predicted.mean) + misfit(model, x, k);
}

}  // namespace detail

/// advance() with the readings made linear again about what they give, until nothing changes: the
/// most probable state given the prediction, by
///
///     x⁽ⁱ⁺¹⁾ = x⁻ + K⁽ⁱ⁾ (z − h(x⁽ⁱ⁾) − H⁽ⁱ⁾ (x⁻ − x⁽ⁱ⁾)),   H⁽ⁱ⁾ = ∂h/∂x at x⁽ⁱ⁾,
///
/// a step being halved that leads to a less probable state. Where that does not converge the
/// instant is the plain extended filter's, and the result says so. With a gate steps are not
/// halved: what it lets through is chosen anew each time. Source: B. M. Bell, F. W. Cathey, IEEE
/// Trans. Automatic Control 38 (1993) 294. Cost: an advance() for each iteration.
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

/// How a run of the iterated filter went.
struct IteratedFilter {
  std::size_t unconverged = 0;  ///< instants, which are the plain extended filter's
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
