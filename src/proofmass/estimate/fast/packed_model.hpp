#pragma once

#include <cstddef>
#include <utility>

#include "proofmass/estimate/filter/linear_series.hpp"
#include "proofmass/estimate/filter/symmetric.hpp"

// Data of fast/packed_kalman.hpp's equations, and what is known of it at compile time.
namespace proofmass::estimate::packed {

/// Entries of F (row i, column j: bit i N + j) and of h (bit j) that are 0 or 1 in every model of a
/// kernel, and whether all of `offset` is 0. Other entries are arbitrary.
struct Pattern {
  unsigned F_zero = 0, F_one = 0, h_zero = 0, h_one = 0;
  bool no_offset = false;
};

/// One step of a model with one channel; `offset` is B u of a constant input.
template <int N>
struct StepModel {
  double F[N][N];
  double Q[Symmetric<N>::entries];
  double h[N];
  double offset[N];
  double R;
};

template <int N, int U>
[[nodiscard]] StepModel<N> step_model(const LinearModel<N, 1, U>& model, const Mat<N>& offset) {
  StepModel<N> out{};
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) out.F[i][j] = model.F(i, j);
    for (int j = 0; j <= i; ++j) out.Q[Symmetric<N>::index(i, j)] = model.Q(i, j);
    out.h[i] = model.H(0, i);
    out.offset[i] = offset(i);
  }
  out.R = model.R(0);
  return out;
}

/// Whether a model has a pattern.
template <int N>
[[nodiscard]] constexpr bool fits(const Pattern& pattern, const StepModel<N>& model) {
  const auto agrees = [](unsigned claimed, int bit, double entry, double value) {
    return (claimed >> bit & 1U) == 0U || entry == value;
  };
  for (int i = 0; i < N; ++i) {
    if (!agrees(pattern.h_zero, i, model.h[i], 0.0) || !agrees(pattern.h_one, i, model.h[i], 1.0))
      return false;
    if (pattern.no_offset && model.offset[i] != 0.0) return false;
    for (int j = 0; j < N; ++j)
      if (!agrees(pattern.F_zero, i * N + j, model.F[i][j], 0.0) ||
          !agrees(pattern.F_one, i * N + j, model.F[i][j], 1.0))
        return false;
  }
  return true;
}

/// States not observable by any measurement of the model: Λ and λ are 0 there.
template <int N>
[[nodiscard]] constexpr unsigned unseen(const Pattern& pattern) {
  constexpr unsigned all = (1U << N) - 1U;
  unsigned seen = ~pattern.h_zero & all;
  for (int pass = 0; pass < N; ++pass)
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        if ((seen >> i & 1U) != 0U && (pattern.F_zero >> (i * N + j) & 1U) == 0U) seen |= 1U << j;
  return ~seen & all;
}

/// One epoch of a filter: x̂ and P after its measurement, K, y / S and 1 / S (all three 0 without a
/// measurement).
template <int N>
struct Row {
  static constexpr int entries = Symmetric<N>::entries;
  double P[entries];
  double x[N];
  double K[N];
  double y_S, per_S;
};

/// Information on a state from later measurements: λ and Λ of filter/bryson_frazier.hpp, and the
/// covariance of the next epoch given all measurements. `wide`: after a wide P, Λ has lost digits
/// that the covariances of earlier epochs still need.
template <int N>
struct Later {
  double L[Symmetric<N>::entries];
  double l[N];
  double next[Symmetric<N>::entries];
  bool wide;
};

namespace detail {

template <int N, class Body>
[[gnu::always_inline]] constexpr void each(Body&& body) {
  [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
    (body(std::integral_constant<int, I>{}), ...);
  }(std::make_integer_sequence<int, N>{});
}

/// body(i, j) for each entry of the lower triangle.
template <int N, class Body>
[[gnu::always_inline]] constexpr void each_lower(Body&& body) {
  each<N>([&](auto i) __attribute__((always_inline)) {
    each<i() + 1>([&](auto j) __attribute__((always_inline)) { body(i, j); });
  });
}

template <int N>
constexpr int at(int i, int j) {
  return static_cast<int>(Symmetric<N>::index(i, j));
}

constexpr bool claimed(unsigned mask, int bit) {
  return (mask >> bit & 1U) != 0U;
}

/// A sum for which it is known at compile time whether it has a term yet.
struct Sum {
  double value = 0.0;
  bool empty = true;
  [[gnu::always_inline]] constexpr void add(double term) {
    value = empty ? term : value + term;
    empty = false;
  }
};

/// sum += factor · value, where `zero` or `one` state the value of factor.
template <bool zero, bool one>
[[gnu::always_inline]] constexpr void add_product(Sum& sum, double factor, double value) {
  if constexpr (zero)
    return;
  else if constexpr (one)
    sum.add(value);
  else
    sum.add(factor * value);
}

template <int N, Pattern S, int i, int j>
[[gnu::always_inline]] constexpr void add_F(Sum& sum, const StepModel<N>& m, double value) {
  add_product<claimed(S.F_zero, i * N + j), claimed(S.F_one, i * N + j)>(sum, m.F[i][j], value);
}

template <int N, Pattern S, int j>
[[gnu::always_inline]] constexpr void add_h(Sum& sum, const StepModel<N>& m, double value) {
  add_product<claimed(S.h_zero, j), claimed(S.h_one, j)>(sum, m.h[j], value);
}

}  // namespace detail

}  // namespace proofmass::estimate::packed
