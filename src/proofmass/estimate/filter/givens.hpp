#pragma once

#include <cmath>

#include "proofmass/estimate/filter/gaussian.hpp"

// Givens rotations of columns, which preserve A Aᵀ: the building block of square-root filters.
// Source: Golub & Van Loan, Matrix Computations (2013), section 5.1.8.
namespace proofmass::estimate::detail {

/// Rotates columns i and j of A so that A(row, j) = 0 and A(row, i) ≥ 0.
template <int Rows, int Columns>
void rotate_away(Mat<Rows, Columns>& A, int row, int i, int j) {
  if (A(row, j) == 0.0 && A(row, i) >= 0.0) return;
  const double size = std::hypot(A(row, i), A(row, j));
  const double c = A(row, i) / size, s = A(row, j) / size;
  const Mat<Rows> old_i = A.col(i);
  A.col(i) = c * old_i + s * A.col(j);
  A.col(j) = c * A.col(j) - s * old_i;
  A(row, i) = size;
  A(row, j) = 0.0;
}

/// Rotates columns until the first `count` rows of A are lower triangular.
template <int Rows, int Columns>
void triangularise(Mat<Rows, Columns>& A, int count) {
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < Columns; ++j) rotate_away(A, i, i, j);
}

/// The lower triangular L with L Lᵀ = A Aᵀ.
template <int Rows, int Columns>
[[nodiscard]] Mat<Rows, Rows> lower_root(Mat<Rows, Columns> A) {
  triangularise(A, Rows);
  return A.template leftCols<Rows>();
}

}  // namespace proofmass::estimate::detail
