#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "proofmass/core/contract.hpp"
#include "proofmass/estimate/filter/smoother.hpp"

// Fixed-point smoother: the state at one past epoch, refined by every new measurement.
namespace proofmass::estimate {

/// A past state, or its first B entries, updated by later measurements. `cross` is the covariance
/// of its error with the error of the present state, Σ = E[(x[j] − x̂[j]) (x[k] − x̂[k])ᵀ].
template <int N, int B = N>
struct PastState {
  Gaussian<B> x;                        ///< x[j] given z[0] … z[k]
  Mat<B, N> cross = Mat<B, N>::Zero();  ///< Σ
  int active = B;                       ///< entries that are estimated; the others are held
                                        /// constant

  /// The state at the present epoch, after its measurements: Σ = P.
  [[nodiscard]] static PastState from(const Gaussian<N>& filtered, int active = N) {
    if constexpr (B == N)
      return {filtered, filtered.cov, active};
    else
      return {{filtered.mean.template head<B>(), filtered.cov.template topLeftCorner<B, B>()},
              filtered.cov.template topRows<B>(),
              std::min(active, B)};
  }
};

/// Updates a past state from epoch k − 1 to k with the filter's step to k. Σ ← Σ Fᵀ, then for each
/// measurement, with the filter's K, y, S and row h,
///
///     x̂[j] ← x̂[j] + Σ hᵀ y / S,   P[j] ← P[j] − Σ hᵀ (Σ hᵀ)ᵀ / S,   Σ ← Σ (I − K h)ᵀ.
///
/// Equal to the fixed-interval smoother of z[0] … z[k] at j, without an inverse. Like that
/// smoother's, its covariance is a difference: no digit is left if the standard deviation at j
/// shrinks by a factor of 1e8 or more. Source: B. D. O. Anderson, J. B. Moore, Optimal Filtering
/// (1979), section 7.2. Cost: O(B N (D + M)).
template <int N, int B, int D, int M>
void learn(PastState<N, B>& past, const Step<N, D, M>& step) {
  past.cross.template leftCols<D>() =
      (past.cross.template leftCols<D>() * step.F.transpose()).eval();
  for (int i = 0; i < step.count; ++i) {
    const Update<N>& u = step.updates[static_cast<std::size_t>(i)];
    if (!u.used) continue;
    const Mat<B> across = past.cross.lazyProduct(u.h);
    past.x.mean += across * (u.innovation / u.variance);
    const Mat<B> w = across / std::sqrt(u.variance);
    subtract_square(past.x.cov.data(), w.data(), {past.active, B});
    past.cross.noalias() -= across * u.gain.transpose();
  }
}

/// The states at selected epochs given every measurement, in the order requested, in one forward
/// pass; memory only for these points. Every point must be an epoch of the model. Cost: the
/// filter's, plus O(N² (D + M)) for each point and each later epoch.
template <StateSpaceModel Model>
[[nodiscard]] std::vector<Gaussian<Model::states>> smooth_points(
    const Model& model,
    const FilterState<Model::states>& prior,
    const Gate& gate,
    std::span<const std::size_t> points) {
  constexpr int N = Model::states;
  for (const std::size_t point : points) PM_EXPECTS(point < model.size());
  std::vector<PastState<N>> past(points.size());
  FilterState<N> state = prior;
  filter(model, {0, model.size()}, gate, state, [&](std::size_t k, const StepOf<Model>& step) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i] == k) past[i] = PastState<N>::from(step.filtered, active_states(model));
      if (points[i] < k) learn(past[i], step);
    }
  });
  std::vector<Gaussian<N>> smoothed;
  smoothed.reserve(past.size());
  for (const PastState<N>& p : past) smoothed.push_back(p.x);
  return smoothed;
}

}  // namespace proofmass::estimate
