#pragma once

#include "proofmass/estimate/filter/dense_kernels.hpp"
#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/estimate/filter/kalman_filter.hpp"

namespace proofmass::estimate {

/// Adjoint λ of all later measurements in the smoother of Bryson and Frazier, x̂[k|N] = x̂[k|k] − P
/// λ: the smoothed means alone, at O(N) a measurement.
template <int N>
struct BackwardScore {
  Mat<N> lambda = Mat<N>::Zero();
  int active = N;  ///< number of estimated states; the others are held constant

  [[nodiscard]] Mat<N> mean(const Gaussian<N>& filtered) const {
    if constexpr (N <= 12) return filtered.mean - filtered.cov * lambda;
    Mat<N> P_lambda = Mat<N>::Zero();
    symmetric_times(filtered.cov.data(), lambda.data(), P_lambda.data(), {active, N});
    return filtered.mean - P_lambda;
  }
};

/// The whole adjoint λ, Λ, for variances too: P[k|N] = P − P Λ P. Equal to the smoother of Rauch,
/// Tung and Striebel without the inverse of a covariance, so it also holds where some states are
/// constant or unobservable. Source: G. J. Bierman, Automatica 9 (1973) 519; S. Särkkä, Bayesian
/// Filtering and Smoothing (2013), theorem 8.2, for the form it replaces.
template <int N>
struct BackwardInformation : BackwardScore<N> {
  using BackwardScore<N>::active;
  Mat<N, N> Lambda = Mat<N, N>::Zero();

  /// Variance of gᵀ x given every measurement.
  [[nodiscard]] double variance(const Gaussian<N>& filtered, const Mat<N>& g) const {
    Mat<N> Pg = Mat<N>::Zero(), LPg = Mat<N>::Zero();
    symmetric_times(filtered.cov.data(), g.data(), Pg.data(), {active, N});
    symmetric_times(Lambda.data(), Pg.data(), LPg.data(), {active, N});
    return g.dot(Pg) - Pg.dot(LPg);
  }
  /// Covariance of the first B states given every measurement.
  template <int B>
  [[nodiscard]] Mat<B, B> cov(const Gaussian<N>& filtered) const {
    Mat<N, B> LP = Mat<N, B>::Zero();  // P is symmetric: its first rows are its first columns
    for (int i = 0; i < B; ++i)
      symmetric_times(Lambda.data(), filtered.cov.col(i).data(), LP.col(i).data(), {active, N});
    return filtered.cov.template topLeftCorner<B, B>() -
           filtered.cov.template leftCols<B>().transpose().lazyProduct(LP);
  }
};

/// Takes the adjoint from after epoch k's measurements to before them.
template <int N, int D, int M>
void look_back_readings(BackwardScore<N>& later, const Step<N, D, M>& step) {
  for (int i = step.count; i-- > 0;) {
    const Update<N>& u = step.updates[static_cast<std::size_t>(i)];
    if (u.used) later.lambda -= u.h * (u.gain.dot(later.lambda) + u.innovation / u.variance);
  }
}
template <int N, int D, int M>
void look_back_readings(BackwardInformation<N>& later, const Step<N, D, M>& step) {
  for (int i = step.count; i-- > 0;) {
    const Update<N>& u = step.updates[static_cast<std::size_t>(i)];
    if (!u.used) continue;
    Mat<N> LK = Mat<N>::Zero();
    symmetric_times(later.Lambda.data(), u.gain.data(), LK.data(), {later.active, N});
    later.lambda -= u.h * (u.gain.dot(later.lambda) + u.innovation / u.variance);
    const Mat<N> half = LK - 0.5 * (u.gain.dot(LK) + 1.0 / u.variance) * u.h;
    subtract_symmetric_pair(later.Lambda.data(), u.h.data(), half.data(), {later.active, N});
  }
}

/// Takes the adjoint from after epoch k to after epoch k − 1, through k's measurements and step.
template <int N, int D, int M>
void look_back(BackwardScore<N>& later, const Step<N, D, M>& step) {
  look_back_readings(later, step);
  later.lambda.template head<D>() = (step.F.transpose() * later.lambda.template head<D>()).eval();
}
template <int N, int D, int M>
void look_back(BackwardInformation<N>& later, const Step<N, D, M>& step) {
  look_back_readings(later, step);
  later.lambda.template head<D>() = (step.F.transpose() * later.lambda.template head<D>()).eval();
  const Mat<D, N> FL = step.F.transpose().lazyProduct(later.Lambda.template topRows<D>());
  later.Lambda.template topRows<D>() = FL;
  later.Lambda.template leftCols<D>() = FL.transpose();
  const Mat<D, D> FLF = FL.template leftCols<D>() * step.F;
  later.Lambda.template topLeftCorner<D, D>() = 0.5 * (FLF + FLF.transpose());
}

}  // namespace proofmass::estimate
