#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/estimate/fast/steady_state.hpp"

// Fixed-lag smoother of a time-invariant model in steady state: the filter with constant gains and
// a finite impulse response on its innovations, at constant cost.
namespace proofmass::estimate {

/// The optimal fixed-lag smoother with settled gains, for measurements at a constant rate with none
/// missing:
///
///     y = z − H x⁻,   x̂[k|k] = x⁻ + K y,   x⁻[k+1] = F x̂[k|k] + B u,
///     x̂[k|k+L] = x̂[k|k] + Σ K_i y[k+i], i = 1 … L,   K_i = P⁺ Fᵀ Aᵀⁱ⁻¹ Hᵀ S⁻¹ = P⁻ Aᵀⁱ Hᵀ S⁻¹,
///
/// with A = F (I − K H). The gains are in steady state from the first epoch, so the first states
/// are suboptimal for a few times SteadyState::slowest_steps; LiveFilter is optimal there, at a
/// higher cost. Source: B. D. O. Anderson, J. B. Moore, Optimal Filtering (1979), section 7.3.
template <int N, int M, int U = 0>
class ConstantGainLag {
 public:
  /// `start` is the predicted state at the first epoch, before its measurements.
  ConstantGainLag(const LinearModel<N, M, U>& model,
                  const SteadyState<N, M>& steady,
                  std::size_t lag,
                  const Mat<N>& start);

  [[nodiscard]] std::size_t lag() const { return taps_.size(); }

  /// Processes one epoch; `u` is the input over the step that ends there. Returns false, without
  /// effect, if a measurement is missing or any value is not finite: this form cannot handle
  /// either. Cost: O(N² + lag · N M).
  [[nodiscard]] bool step(const Mat<M>& z, const Mat<U>& u = Mat<U>::Zero());

  /// x̂[k|k] of the last epoch k; `start` before the first.
  [[nodiscard]] const Mat<N>& filtered() const { return filtered_; }
  /// x̂[k − lag|k]; nullopt in the first `lag` epochs.
  [[nodiscard]] std::optional<Mat<N>> lagged() const;
  /// K_i, i = 1 … lag.
  [[nodiscard]] const Mat<N, M>& tap(std::size_t i) const {
    PM_EXPECTS(i >= 1 && i <= taps_.size());
    return taps_[i - 1];
  }

 private:
  /// A past epoch: its filtered state and its innovation.
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
