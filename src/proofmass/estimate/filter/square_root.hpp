#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "proofmass/estimate/filter/givens.hpp"
#include "proofmass/estimate/filter/linear_run.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/positive_root.hpp"
#include "proofmass/estimate/filter/square_root_evidence.hpp"

// Linear filter and smoother with a root of the covariance, P = S Sᵀ with S lower triangular. For
// data in which a covariance in 53 bits loses the small directions or its definiteness:
// measurements much more precise than the prior, or of very different precision. All operations are
// rotations of columns or sums of squares, so P stays definite, and half the digits suffice. Two to
// four times the arithmetic of smooth_linear(). Source: P. G. Kaminski, A. E. Bryson, S. F.
// Schmidt, IEEE Transactions on Automatic Control 16 (1971) 727; N. A. Carlson, AIAA Journal 11
// (1973) 1259, for sequential measurements.
namespace proofmass::estimate {

/// Results of filter_linear() and smooth_linear(), and the roots themselves: the covariances in
/// `run` are their squares, rounded.
template <int N, int M>
struct SquareRootRun {
  LinearRun<N, M> run;
  std::vector<Mat<N, N>> filtered_root, smoothed_root;  ///< lower triangular, one for each epoch
};

namespace detail {

/// Updates x̂ and S with one measurement: the rotations that turn (√R, hᵀS) into (√S, 0), last
/// column first so that S stays triangular, turn (0, S) into (K √S, S⁺).
template <int N>
[[nodiscard]] Update<N> correct_root(Mat<N>& mean,
                                     Mat<N, N>& root,
                                     const Reading<N>& reading,
                                     const Gate& gate) {
  Update<N> update;
  update.h = reading.h;
  update.innovation = reading.value - reading.h.dot(mean);
  const Mat<N> f = root.transpose() * reading.h;
  update.expected = update.variance = f.squaredNorm() + reading.variance;
  const double off = std::abs(update.innovation) / std::sqrt(update.expected);
  update.used = off <= gate.limit;
  update.gain.setZero();
  if (!update.used) return update;
  if (off > gate.huber) update.variance *= off / gate.huber;
  Mat<N + 1, N + 1> array = Mat<N + 1, N + 1>::Zero();
  array(0, 0) = std::sqrt(reading.variance + (update.variance - update.expected));
  array.row(0).template tail<N>() = f.transpose();
  array.template bottomRightCorner<N, N>() = root;
  for (int j = N; j > 0; --j) rotate_away(array, 0, 0, j);
  update.gain = array.col(0).template tail<N>() / array(0, 0);
  mean += update.gain * update.innovation;
  root = array.template bottomRightCorner<N, N>();
  return update;
}

template <int N>
[[nodiscard]] PackedGaussian<N> squared(const Mat<N>& mean, const Mat<N, N>& root) {
  return PackedGaussian<N>::of({mean, root * root.transpose()});
}

/// The filter; calls visit(k, step, root) for each epoch.
template <int N, int M, int U, class Visit>
void run_square_root(const LinearSeries<N, M, U>& series,
                     const Gaussian<N>& prior,
                     const Gate& gate,
                     Visit&& visit) {
  const Mat<N, N> prior_root = positive_root<N>(prior.cov);
  Mat<N> mean = prior.mean;
  Mat<N, N> root = prior_root;
  int epochs_gated = 0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    Step<N, N, M> step;
    if (k > 0) {
      const auto transition = series.transition(mean, k);
      mean = transition.mean;
      Mat<N, 2 * N> array;
      array << transition.F * root, positive_root<N>(transition.Q);
      root = lower_root<N, 2 * N>(array);
    }
    if (epochs_gated >= gate.patience) {
      root = prior_root;
      epochs_gated = 0;
    }
    Readings<N, M> readings;
    series.measure(mean, k, readings);
    step.count = readings.count;
    bool any_used = false;
    for (int i = 0; i < step.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      step.updates[at] = correct_root<N>(mean, root, readings.rows[at], gate);
      any_used = any_used || step.updates[at].used;
    }
    if (step.count > 0) epochs_gated = any_used ? 0 : epochs_gated + 1;
    step.filtered = {mean, root * root.transpose()};
    visit(k, std::as_const(step), std::as_const(root));
  }
}

}  // namespace detail

/// Runs the filter from a prior. There are no diffuse directions; a root does not need them, since
/// a variance of 1e20 costs no digits. Cost: O(epochs · N² (N + M)).
template <int N, int M, int U>
[[nodiscard]] SquareRootRun<N, M> filter_square_root(const LinearSeries<N, M, U>& series,
                                                     const Gaussian<N>& prior,
                                                     const Gate& gate = {}) {
  SquareRootRun<N, M> out;
  out.run.steps.resize(series.size());
  detail::run_square_root(series, prior, gate,
                          [&](std::size_t k, const auto& step, const Mat<N, N>& root) {
                            detail::note(series, k, step, out.run);
                            out.filtered_root.push_back(root);
                          });
  out.smoothed_root = out.filtered_root;
  return out;
}

/// Filter and fixed-interval smoother, equal to smooth_linear(), with lag-one covariances. Combines
/// the filter's root with a backward least-squares form of the later measurements:
///
///     x̂[k|N] = x̂ + S ŵ,   P[k|N] = S (I + Sᵀ Ω S)⁻¹ Sᵀ,   Ω = Σ u uᵀ of the evidence after k
///
/// without forming Ω. No recursion uses its own output, so errors do not accumulate. Source: D. C.
/// Fraser, J. E. Potter, IEEE Transactions on Automatic Control 14 (1969) 387, for two filters;
/// Bierman (1977), chapters V and X, for least squares by rotations.
template <int N, int M, int U>
[[nodiscard]] SquareRootRun<N, M> smooth_square_root(const LinearSeries<N, M, U>& series,
                                                     const Gaussian<N>& prior,
                                                     const Gate& gate = {}) {
  SquareRootRun<N, M> out;
  auto& steps = out.run.steps;
  steps.resize(series.size());
  std::vector<Mat<M>> variances;
  detail::run_square_root(series, prior, gate,
                          [&](std::size_t k, const auto& step, const Mat<N, N>& root) {
                            detail::note(series, k, step, out.run);
                            out.filtered_root.push_back(root);
                            Readings<N, M> readings;
                            series.measure(Mat<N>::Zero(), k, readings);
                            variances.push_back(detail::variances_used(step, readings));
                          });
  out.smoothed_root = out.filtered_root;
  if (series.size() < 2) return out;
  out.run.lag_one.resize(series.size() - 1);
  detail::Evidence<N> later = detail::Evidence<N>::Zero();
  for (std::size_t k = series.size() - 1; k-- > 0;) {
    detail::add_readings(later, series, k + 1, variances[k + 1]);
    const auto& x = steps[k].filtered;
    const auto both = detail::joint<N>({x.mean, {}}, out.filtered_root[k],
                                       series.transition(x.mean, k + 1), later);
    out.smoothed_root[k] = detail::lower_root<N, 2 * N>(both.now);
    out.run.lag_one[k] = both.next * both.now.transpose();
    steps[k].smoothed = detail::squared<N>(both.mean, out.smoothed_root[k]);
    detail::step_back<N>(later, series.transition(Mat<N>::Zero(), k + 1),
                         positive_root<N>(series.model(k + 1).Q));
  }
  return out;
}

}  // namespace proofmass::estimate
