#pragma once

#include <cstddef>

#include "proofmass/estimate/filter/linear_run.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/positive_root.hpp"

namespace proofmass::estimate::detail {

/// Rauch–Tung–Striebel smoother over the epochs of a filtered run from `first` on:
///
///     x⁻ = F x̂[k] + B u[k+1],  P⁻ = F P Fᵀ + Q,  G = P Fᵀ (P⁻)⁻¹
///     x̂[k|N] = x̂[k] + G (x̂[k+1|N] − x⁻),  P[k|N] = P + G (P[k+1|N] − P⁻) Gᵀ
///     cov(x[k+1], x[k]|N) = P[k+1|N] Gᵀ
///
/// If P⁻ is singular, G is one of the possible gains. A step with a covariance reset is treated as
/// any other. Source: H. E. Rauch, F. Tung, C. T. Striebel, AIAA Journal 3 (1965) 1445; Särkkä
/// (2013), theorem 8.2, with the known input.
template <int N, int M, int U>
void smooth_back_by_gains(const LinearSeries<N, M, U>& series,
                          std::size_t first,
                          LinearRun<N, M>& run) {
  if (series.size() == 0) return;
  Gaussian<N> smoothed = run.steps.back().filtered;
  for (std::size_t k = series.size() - 1; k-- > first;) {
    const Gaussian<N> x = run.steps[k].filtered;
    const auto step = series.transition(x.mean, k + 1);
    const Mat<N, N> FP = step.F * x.cov;
    const Mat<N, N> FPF = FP * step.F.transpose();
    const Mat<N, N> predicted = 0.5 * (FPF + FPF.transpose()) + step.Q;
    const Mat<N, N> Gt = solve_root<N, N>(positive_root<N>(predicted), FP);
    if (!run.lag_one.empty()) run.lag_one[k] = smoothed.cov * Gt;
    const Mat<N, N> gained = Gt.transpose() * (smoothed.cov - predicted) * Gt;
    smoothed.mean = (x.mean + Gt.transpose() * (smoothed.mean - step.mean)).eval();
    smoothed.cov = x.cov + 0.5 * (gained + gained.transpose());
    run.steps[k].smoothed = PackedGaussian<N>::of(smoothed);
  }
}

}  // namespace proofmass::estimate::detail
