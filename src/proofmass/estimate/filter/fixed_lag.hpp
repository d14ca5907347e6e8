#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/filter/fixed_point.hpp"

// Fixed-lag smoother: each state given the measurements up to a fixed number of epochs after it,
// online.
namespace proofmass::estimate {

/// The last states of a run, each given all measurements so far: a ring of fixed-point smoothers.
/// Steps may be irregular and measurements missing. Memory is fixed at construction; a step does
/// not allocate.
///
/// The smoother is optimal: the state `lag` epochs ago, or its first B entries, equals the
/// fixed-interval smoother's at the end of the measurements so far. (Recursions that use the
/// filtered P and F − K H instead of P⁻ and F (I − K H) are not optimal.) Source: B. D. O.
/// Anderson, J. B. Moore, Optimal Filtering (1979), section 7.3; J. B. Moore, Automatica 9 (1973)
/// 163.
template <int N, int B = N>
class FixedLag {
 public:
  explicit FixedLag(std::size_t lag) : ring_(lag + 1) {}

  [[nodiscard]] std::size_t lag() const { return ring_.size() - 1; }
  /// Number of states held; lag() + 1 after that many epochs.
  [[nodiscard]] std::size_t size() const { return std::min(pushed_, ring_.size()); }

  /// Appends an epoch. Cost: O(lag · B N (D + M)).
  template <int D, int M>
  void push(const Step<N, D, M>& step, int active = N) {
    const std::size_t newest = pushed_ % ring_.size();
    for (std::size_t i = 0; i < size(); ++i)
      if (i != newest) learn(ring_[i], step);
    ring_[newest] = PastState<N, B>::from(step.filtered, active);
    ++pushed_;
  }

  /// The state `ago` < size() epochs before the last, given all measurements up to the last.
  [[nodiscard]] const Gaussian<B>& state(std::size_t ago) const {
    PM_EXPECTS(ago < size());
    return ring_[(pushed_ - 1 - ago) % ring_.size()].x;
  }

 private:
  std::vector<PastState<N, B>> ring_;
  std::size_t pushed_ = 0;
};

/// Runs filter and fixed-lag smoother over all epochs of a model and calls visit(k, x) once for
/// each, in rising k: x[k] given z[0] … z[k + lag], or given all if the model ends before.
template <StateSpaceModel Model, class Visit>
void smooth_fixed_lag(const Model& model,
                      const FilterState<Model::states>& prior,
                      const Gate& gate,
                      std::size_t lag,
                      Visit&& visit) {
  constexpr int N = Model::states;
  const std::size_t size = model.size();
  if (size == 0) return;
  FixedLag<N> window(std::min(lag, size - 1));
  FilterState<N> state = prior;
  filter(model, {0, size}, gate, state, [&](std::size_t k, const StepOf<Model>& step) {
    window.push(step, active_states(model));
    if (k >= lag) visit(k - lag, window.state(lag));
  });
  for (std::size_t ago = std::min(lag, size); ago-- > 0;) visit(size - 1 - ago, window.state(ago));
}

}  // namespace proofmass::estimate
