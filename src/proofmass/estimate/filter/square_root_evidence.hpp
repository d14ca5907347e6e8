#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "proofmass/estimate/filter/givens.hpp"
#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/positive_root.hpp"

// Backward pass of the square-root smoother: information from later measurements, as least squares.
namespace proofmass::estimate::detail {

/// Information on the state from later measurements as rows of least squares, uᵀ x = ζ + N(0, 1),
/// each a column (u, ζ).
template <int N>
using Evidence = Mat<N + 1, N>;

/// Takes evidence on x[k] from after its measurements to before: a row h/√R, z/√R for each one
/// used.
template <int N, int M, int U>
void add_readings(Evidence<N>& later,
                  const LinearSeries<N, M, U>& series,
                  std::size_t k,
                  const Mat<M>& variance_used) {
  Readings<N, M> readings;
  series.measure(Mat<N>::Zero(), k, readings);
  Mat<N + 1, N + M> array = Mat<N + 1, N + M>::Zero();
  array.template leftCols<N>() = later;
  for (int i = 0; i < readings.count; ++i) {
    const Reading<N>& reading = readings.rows[static_cast<std::size_t>(i)];
    if (std::isnan(variance_used(i))) continue;
    const double std = std::sqrt(variance_used(i));
    array.col(N + i) << reading.h / std, reading.value / std;
  }
  triangularise(array, N);
  later = array.template leftCols<N>();
}

/// Takes evidence on x[k] to evidence on x[k−1], with x[k] = F x[k−1] + B u + √Q ω: the rows that
/// remain when ω ~ N(0, I) is eliminated. `step` is the transition of the state 0.
template <int N>
void step_back(Evidence<N>& later, const Transition<N, N>& step, const Mat<N, N>& root_Q) {
  const Mat<N, N> u = later.template topRows<N>();
  Mat<2 * N + 1, 2 * N> array = Mat<2 * N + 1, 2 * N>::Zero();
  array.template topLeftCorner<N, N>().setIdentity();
  array.template topRightCorner<N, N>() = root_Q.transpose() * u;
  array.template block<N, N>(N, N) = step.F.transpose() * u;
  array.row(2 * N).template tail<N>() = later.row(N) - step.mean.transpose() * u;
  triangularise(array, N);
  later = array.template bottomRightCorner<N + 1, N>();
}

/// x[k] = x̂ + S w and ω between it and x[k+1], given all measurements: (ω, w) ~ N(L⁻ᵀ y, (L Lᵀ)⁻¹).
template <int N>
struct Joint {
  Mat<N> mean;
  Mat<N, 2 * N> now, next;  ///< roots of the covariances of x[k] and x[k+1], not triangular
};

/// Least squares of ω = 0 + N(0, I), w = 0 + N(0, I) and the evidence on x[k+1]. The identity keeps
/// L's diagonal at 1 or above, so there is no division by a small number.
template <int N>
[[nodiscard]] Joint<N> joint(const Gaussian<N>& x,
                             const Mat<N, N>& root,
                             const Transition<N, N>& step,
                             const Evidence<N>& from_next) {
  Mat<N, 2 * N> next, now;
  next << positive_root<N>(step.Q), step.F * root;
  now << Mat<N, N>::Zero(), root;
  const Mat<N, N> u = from_next.template topRows<N>();
  Mat<2 * N + 1, 3 * N> array = Mat<2 * N + 1, 3 * N>::Zero();
  array.template topLeftCorner<2 * N, 2 * N>().setIdentity();
  array.template topRightCorner<2 * N, N>() = next.transpose() * u;
  array.row(2 * N).template tail<N>() = from_next.row(N) - step.mean.transpose() * u;
  triangularise(array, 2 * N);
  for (int j = 0; j < 2 * N; ++j) {
    for (int i = 0; i < j; ++i) {
      now.col(j) -= now.col(i) * array(j, i);
      next.col(j) -= next.col(i) * array(j, i);
    }
    now.col(j) /= array(j, j);
    next.col(j) /= array(j, j);
  }
  const Mat<2 * N> y = array.row(2 * N).template head<2 * N>().transpose();
  return {x.mean + now * y, now, next};
}

/// Variance with which each channel's measurement was used; NaN if it was not.
template <int N, int M>
[[nodiscard]] Mat<M> variances_used(const Step<N, N, M>& step, const Readings<N, M>& readings) {
  Mat<M> out = Mat<M>::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < step.count; ++i) {
    const Update<N>& update = step.updates[static_cast<std::size_t>(i)];
    if (update.used)
      out(i) =
          readings.rows[static_cast<std::size_t>(i)].variance + (update.variance - update.expected);
  }
  return out;
}

}  // namespace proofmass::estimate::detail
