#pragma once

#include "proofmass/estimate/fast/packed_model.hpp"

// The equations of filter/smoother.hpp on packed covariances, for a time-invariant model with one
// channel. Each is written once, on plain numbers, and runs either on one epoch after another
// (fast/packed_filter.cpp) or side by side on many (fast/uniform_lanes.cpp). Zeros and ones of the
// model are exploited at compile time (Pattern).
namespace proofmass::estimate::packed {

/// x ← F x + offset
template <int N, Pattern S>
[[gnu::always_inline]] inline void predict_mean(const StepModel<N>& m, double (&x)[N]) {
  using namespace detail;
  double moved[N];
  each<N>([&](auto i) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto j) __attribute__((always_inline)) { add_F<N, S, i(), j()>(sum, m, x[j()]); });
    if constexpr (!S.no_offset) sum.add(m.offset[i()]);
    moved[i()] = sum.value;
  });
  each<N>([&](auto i) __attribute__((always_inline)) { x[i()] = moved[i()]; });
}

/// P ← F P Fᵀ + Q
template <int N, Pattern S>
[[gnu::always_inline]] inline void predict_cov(const StepModel<N>& m,
                                               double (&P)[Symmetric<N>::entries]) {
  using namespace detail;
  double FP[N][N];
  each<N>([&](auto i) __attribute__((always_inline)) {
    each<N>([&](auto j) __attribute__((always_inline)) {
      Sum sum;
      each<N>([&](auto k) __attribute__((always_inline)) {
        add_F<N, S, i(), k()>(sum, m, P[at<N>(k(), j())]);
      });
      FP[i()][j()] = sum.value;
    });
  });
  each_lower<N>([&](auto i, auto j) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto k)
                __attribute__((always_inline)) { add_F<N, S, j(), k()>(sum, m, FP[i()][k()]); });
    P[at<N>(i(), j())] = sum.value + m.Q[at<N>(i(), j())];
  });
}

/// h x
template <int N, Pattern S>
[[gnu::always_inline]] inline double predicted_reading(const StepModel<N>& m,
                                                       const double (&x)[N]) {
  using namespace detail;
  Sum sum;
  each<N>([&](auto j) __attribute__((always_inline)) { add_h<N, S, j()>(sum, m, x[j()]); });
  return sum.value;
}

/// P ← P − (P hᵀ)(P hᵀ)ᵀ / S, K = P hᵀ / S. Returns 1 / S.
template <int N, Pattern S>
[[gnu::always_inline]] inline double correct_cov(const StepModel<N>& m,
                                                 double (&P)[Symmetric<N>::entries],
                                                 double (&K)[N]) {
  using namespace detail;
  double Ph[N];
  each<N>([&](auto i) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto j)
                __attribute__((always_inline)) { add_h<N, S, j()>(sum, m, P[at<N>(i(), j())]); });
    Ph[i()] = sum.value;
  });
  const double per_S = 1.0 / (predicted_reading<N, S>(m, Ph) + m.R);
  each<N>([&](auto i) __attribute__((always_inline)) { K[i()] = Ph[i()] * per_S; });
  each_lower<N>([&](auto i, auto j)
                    __attribute__((always_inline)) { P[at<N>(i(), j())] -= K[i()] * Ph[j()]; });
  return per_S;
}

/// λ ← Fᵀ (λ − hᵀ (Kᵀ λ + y / S))
template <int N, Pattern S>
[[gnu::always_inline]] inline void mean_back(const StepModel<N>& m,
                                             const double (&K)[N],
                                             double y_S,
                                             double (&l)[N]) {
  using namespace detail;
  constexpr unsigned nothing = unseen<N>(S);
  Sum Kl;
  each<N>([&](auto j) __attribute__((always_inline)) {
    add_product<claimed(nothing, j()), false>(Kl, K[j()], l[j()]);
  });
  const double total = Kl.value + y_S;
  double kept[N];
  each<N>([&](auto j) __attribute__((always_inline)) {
    Sum sum{l[j()], false};
    add_h<N, S, j()>(sum, m, -total);
    kept[j()] = sum.value;
  });
  each<N>([&](auto j) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto i) __attribute__((always_inline)) {
      if constexpr (!claimed(nothing, i())) add_F<N, S, i(), j()>(sum, m, kept[i()]);
    });
    l[j()] = sum.value;
  });
}

/// Λ ← (I − K h)ᵀ Λ (I − K h) + hᵀ h / S
template <int N, Pattern S>
[[gnu::always_inline]] inline void uncorrect_Lambda(const StepModel<N>& m,
                                                    const double (&K)[N],
                                                    double per_S,
                                                    double (&L)[Symmetric<N>::entries]) {
  using namespace detail;
  constexpr unsigned nothing = unseen<N>(S);
  double LK[N];
  Sum KLK;
  each<N>([&](auto i) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto j) __attribute__((always_inline)) {
      add_product<claimed(nothing, i()) || claimed(nothing, j()), false>(sum, L[at<N>(i(), j())],
                                                                         K[j()]);
    });
    LK[i()] = sum.value;
    add_product<claimed(nothing, i()), false>(KLK, K[i()], LK[i()]);
  });
  const double half = 0.5 * (KLK.value + per_S);
  each<N>([&](auto i) __attribute__((always_inline)) {
    Sum sum{LK[i()], false};
    add_h<N, S, i()>(sum, m, -half);
    LK[i()] = sum.value;
  });
  each_lower<N>([&](auto i, auto j) __attribute__((always_inline)) {
    Sum sum{L[at<N>(i(), j())], false};
    add_h<N, S, i()>(sum, m, -LK[j()]);
    add_h<N, S, j()>(sum, m, -LK[i()]);
    L[at<N>(i(), j())] = sum.value;
  });
}

/// Λ ← Fᵀ Λ F
template <int N, Pattern S>
[[gnu::always_inline]] inline void unpredict_Lambda(const StepModel<N>& m,
                                                    double (&L)[Symmetric<N>::entries]) {
  using namespace detail;
  constexpr unsigned nothing = unseen<N>(S);
  double LF[N][N];
  each<N>([&](auto i) __attribute__((always_inline)) {
    each<N>([&](auto j) __attribute__((always_inline)) {
      Sum sum;
      each<N>([&](auto k) __attribute__((always_inline)) {
        if constexpr (!claimed(nothing, i()) && !claimed(nothing, k()))
          add_F<N, S, k(), j()>(sum, m, L[at<N>(i(), k())]);
      });
      LF[i()][j()] = sum.value;
    });
  });
  each_lower<N>([&](auto i, auto j) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto k) __attribute__((always_inline)) {
      if constexpr (!claimed(nothing, k())) add_F<N, S, k(), i()>(sum, m, LF[k()][j()]);
    });
    L[at<N>(i(), j())] = sum.value;
  });
}

/// x ← x − P λ
template <int N, Pattern S>
[[gnu::always_inline]] inline void smooth_mean(const double (&P)[Symmetric<N>::entries],
                                               const double (&l)[N],
                                               double (&x)[N]) {
  using namespace detail;
  constexpr unsigned nothing = unseen<N>(S);
  each<N>([&](auto i) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto j) __attribute__((always_inline)) {
      add_product<claimed(nothing, j()), false>(sum, P[at<N>(i(), j())], l[j()]);
    });
    x[i()] -= sum.value;
  });
}

/// P ← P − P Λ P
template <int N, Pattern S>
[[gnu::always_inline]] inline void smooth_cov(const double (&L)[Symmetric<N>::entries],
                                              double (&P)[Symmetric<N>::entries]) {
  using namespace detail;
  constexpr unsigned nothing = unseen<N>(S);
  double LP[N][N], smoothed[Symmetric<N>::entries];
  each<N>([&](auto i) __attribute__((always_inline)) {
    each<N>([&](auto j) __attribute__((always_inline)) {
      Sum sum;
      each<N>([&](auto k) __attribute__((always_inline)) {
        add_product<claimed(nothing, i()) || claimed(nothing, k()), false>(sum, L[at<N>(i(), k())],
                                                                           P[at<N>(k(), j())]);
      });
      LP[i()][j()] = sum.value;
    });
  });
  each_lower<N>([&](auto i, auto j) __attribute__((always_inline)) {
    Sum sum;
    each<N>([&](auto k) __attribute__((always_inline)) {
      add_product<claimed(nothing, k()), false>(sum, P[at<N>(i(), k())], LP[k()][j()]);
    });
    smoothed[at<N>(i(), j())] = P[at<N>(i(), j())] - sum.value;
  });
  each<Symmetric<N>::entries>([&](auto e)
                                  __attribute__((always_inline)) { P[e()] = smoothed[e()]; });
}

}  // namespace proofmass::estimate::packed
