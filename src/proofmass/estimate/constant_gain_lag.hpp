#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/steady_state.hpp"

// The fixed-lag smoother of a model that does not change, in its steady state: the filter with
// constant gains and a finite impulse response on its innovations, at constant cost.
namespace proofmass::estimate {

/// The optimal fixed-lag smoother once the gains have settled, for readings that come at a constant
/// rate with none missing:
///
///     y = z − H x⁻,   x̂[k|k] = x⁻ + K y,   x⁻[k+1] = F x̂[k|k] + B u,
///     x̂[k|k+L] = x̂[k|k] + Σ K_i y[k+i], i = 1 … L,   K_i = P⁺ Fᵀ Aᵀⁱ⁻¹ Hᵀ S⁻¹ = P⁻ Aᵀⁱ Hᵀ S⁻¹,
///
/// A = F (I − K H). It starts as if it had run for ever, so its first states, for as long as
/// SteadyState::slowest_steps and a few times that, are not the best there are: LiveFilter's are,
/// for more work. Source: B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979), section 7.3.
template <int N, int M, int U = 0>
class ConstantGainLag {
 public:
  /// `start` is what is expected at the first instant before its reading.
  ConstantGainLag(const LinearModel<N, M, U>& model,
                  const SteadyState<N, M>& steady,
                  std::size_t lag,
                  const Mat<N>& start);

  [[nodiscard]] std::size_t lag() const { return taps_.size(); }

  /// Takes one instant; `u` is the input over the step that ends there. False, and nothing done,
  /// where a reading is missing or anything is not finite: this form has no answer to that.
  /// Cost: O(N² + lag · N M).
  [[nodiscard]] bool step(const Mat<M>& z, const Mat<U>& u = Mat<U>::Zero());

  /// x̂[k|k] of the last instant k; the start before the first.
  [[nodiscard]] const Mat<N>& filtered() const { return filtered_; }
  /// x̂[k − lag|k]; nullopt in the first `lag` instants.
  [[nodiscard]] std::optional<Mat<N>> lagged() const;
  /// K_i, i = 1 … lag.
  [[nodiscard]] const Mat<N, M>& tap(std::size_t i) const {
    PM_EXPECTS(i >= 1 && i <= taps_.size());
    return taps_[i - 1];
  }

 private:
  /// One instant of the past: its filtered state and its innovation.
  struct Past {
    Mat<N> filtered;
    Mat<M> innovation;
  };

  LinearModel<N, M, U> model_;
  Mat<N, M> gain_;
  std::vector<Mat<N, M>> taps_;
  std::vector<Past> past_;  ///< ring of lag + 1
  std::size_t steps_ = 0;
  Mat<N> filtered_;
};

template <int N, int M, int U>
ConstantGainLag<N, M, U>::ConstantGainLag(const LinearModel<N, M, U>& model,
                                          const SteadyState<N, M>& steady,
                                          std::size_t lag,
                                          const Mat<N>& start)
    : model_(model), gain_(steady.gain), taps_(lag), past_(lag + 1), filtered_(start) {
  const Mat<N, N> At = (model.F * (Mat<N, N>::Identity() - gain_ * model.H)).transpose();
  const Eigen::MatrixXd S_inverse = positive_inverse(steady.innovation_variance);
  Mat<N, M> column = model.H.transpose() * S_inverse;
  for (Mat<N, M>& tap : taps_) {
    tap = steady.seen * (model.F.transpose() * column);
    column = (At * column).eval();
  }
}

template <int N, int M, int U>
bool ConstantGainLag<N, M, U>::step(const Mat<M>& z, const Mat<U>& u) {
  if (!z.allFinite() || !u.allFinite()) return false;
  if (steps_ > 0) {
    filtered_ = (model_.F * filtered_).eval();
    if constexpr (U > 0) filtered_ += model_.B * u;
  }
  Past& now = past_[steps_ % past_.size()];
  now.innovation = z - model_.H * filtered_;
  filtered_ += gain_ * now.innovation;
  now.filtered = filtered_;
  ++steps_;
  return true;
}

template <int N, int M, int U>
std::optional<Mat<N>> ConstantGainLag<N, M, U>::lagged() const {
  if (steps_ < past_.size()) return std::nullopt;
  const std::size_t size = past_.size();
  std::size_t at = steps_ % size;  // the oldest
  Mat<N> x = past_[at].filtered;
  for (const Mat<N, M>& tap : taps_) {
    if (++at == size) at = 0;
    x += tap * past_[at].innovation;
  }
  return x;
}

}  // namespace proofmass::estimate
