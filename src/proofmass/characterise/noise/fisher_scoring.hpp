#pragma once

#include <Eigen/Core>
#include <utility>

namespace proofmass::characterise {

/// Termination of an ascent.
struct ClimbLimits {
  int most_steps = 60;
  double least_gain;  ///< in log-likelihood: a step that gains less is the last
};

/// Fisher scoring ascent from θ: each step goes towards the problem's `scored` at a state, halved
/// until the log-likelihood does not fall. A problem has
///
///     State at(θ) const                with a member log_likelihood
///     Eigen::VectorXd scored(State) const
///
/// `state` must be that of `theta`. Source: R. I. Jennrich, P. F. Sampson, Technometrics 18 (1976)
/// 11, for variance components.
template <class Problem, class State>
void climb(const Problem& problem,
           const ClimbLimits& limits,
           Eigen::VectorXd& theta,
           State& state) {
  constexpr int most_halvings = 12;
  for (int step = 0; step < limits.most_steps; ++step) {
    const Eigen::VectorXd next = problem.scored(state);
    const double before = state.log_likelihood;
    bool up = false;
    double fraction = 1.0;
    for (int halving = 0; halving < most_halvings && !up; ++halving, fraction *= 0.5) {
      Eigen::VectorXd tried = theta + fraction * (next - theta);
      State there = problem.at(tried);
      up = there.log_likelihood >= before;
      if (!up) continue;
      theta = std::move(tried);
      state = std::move(there);
    }
    if (!up || state.log_likelihood - before < limits.least_gain) return;
  }
}

}  // namespace proofmass::characterise
