#pragma once

#include <cmath>
#include <limits>

#include "proofmass/estimate/filter/gaussian.hpp"

namespace proofmass::estimate {

/// The lower triangular L with L Lᵀ = A, for a symmetric positive semi-definite A: a column is zero
/// if only rounding remains of its pivot. Reads the lower triangle. Source: G. H. Golub, C. F. Van
/// Loan, Matrix Computations (2013), section 4.2.8. Cost: O(N³).
template <int N>
[[nodiscard]] Mat<N, N> positive_root(const Mat<N, N>& A) {
  constexpr double rounding = 4 * N * std::numeric_limits<double>::epsilon();
  Mat<N, N> L = Mat<N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    double pivot = A(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    if (!(pivot > rounding * A(j, j))) continue;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) {
      double sum = A(i, j);
      for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
      L(i, j) = sum / L(j, j);
    }
  }
  return L;
}

/// A solution X of L Lᵀ X = B, if one exists; for a singular L the undetermined entries are 0.
template <int N, int Columns>
[[nodiscard]] Mat<N, Columns> solve_root(const Mat<N, N>& L, Mat<N, Columns> B) {
  const auto divided = [&](double sum, int i) { return L(i, i) > 0.0 ? sum / L(i, i) : 0.0; };
  for (int c = 0; c < Columns; ++c) {
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < i; ++k) B(i, c) -= L(i, k) * B(k, c);
      B(i, c) = divided(B(i, c), i);
    }
    for (int i = N; i-- > 0;) {
      for (int k = i + 1; k < N; ++k) B(i, c) -= L(k, i) * B(k, c);
      B(i, c) = divided(B(i, c), i);
    }
  }
  return B;
}

}  // namespace proofmass::estimate
