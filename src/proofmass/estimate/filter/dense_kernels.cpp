#include "proofmass/estimate/filter/dense_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/vector_clones.hpp"

namespace proofmass::estimate {
namespace {

/// y ← (I − K hᵀ) y; `from` is a copy of y before.
void keep_rest(const double* K, const double* h, const double* from, double* y, int n) {
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += ((i == k ? 1.0 : 0.0) - K[i] * h[k]) * from[k];
    y[i] = sum;
  }
}

}  // namespace

PM_VECTOR_CLONES void symmetric_times(const double* __restrict A,
                                      const double* __restrict x,
                                      double* __restrict y,
                                      SquareExtent extent) {
  const int n = extent.n, stride = extent.stride;
  for (int i = 0; i < n; ++i) y[i] = 0.0;
  int j = 0;
  for (; j + 4 <= n; j += 4) {
    const double *a0 = A + j * stride, *a1 = a0 + stride, *a2 = a1 + stride, *a3 = a2 + stride;
    const double x0 = x[j], x1 = x[j + 1], x2 = x[j + 2], x3 = x[j + 3];
    // A measurement depends on few of the states.
    if (x0 == 0.0 && x1 == 0.0 && x2 == 0.0 && x3 == 0.0) continue;
    for (int i = 0; i < n; ++i) y[i] += (a0[i] * x0 + a1[i] * x1) + (a2[i] * x2 + a3[i] * x3);
  }
  for (; j < n; ++j)
    for (int i = 0; i < n; ++i) y[i] += A[j * stride + i] * x[j];
}

PM_VECTOR_CLONES void subtract_square(double* __restrict A,
                                      const double* __restrict w,
                                      SquareExtent extent) {
  const int n = extent.n, stride = extent.stride;
  for (int j = 0; j < n; ++j) {
    double* column = A + j * stride;
    const double wj = w[j];
    for (int i = 0; i < n; ++i) column[i] -= w[i] * wj;
  }
}

PM_VECTOR_CLONES void subtract_symmetric_pair(double* __restrict A,
                                              const double* __restrict a,
                                              const double* __restrict b,
                                              SquareExtent extent) {
  const int n = extent.n, stride = extent.stride;
  for (int j = 0; j < n; ++j) {
    double* column = A + j * stride;
    const double aj = a[j], bj = b[j];
    for (int i = 0; i < n; ++i) column[i] -= a[i] * bj + b[i] * aj;
  }
}

void joseph_update(double* P, const double* h, const double* K, double R, SquareExtent extent) {
  const int n = extent.n, stride = extent.stride;
  PM_EXPECTS(n <= most_states);
  std::array<double, most_states> from, kept;
  for (int j = 0; j < n; ++j) {  // (I − K hᵀ) P, column by column
    std::copy_n(P + j * stride, n, from.data());
    keep_rest(K, h, from.data(), P + j * stride, n);
  }
  for (int i = 0; i < n; ++i) {  // times (I − K hᵀ)ᵀ, row by row
    for (int j = 0; j < n; ++j) from[static_cast<std::size_t>(j)] = P[j * stride + i];
    keep_rest(K, h, from.data(), kept.data(), n);
    for (int j = 0; j < n; ++j)
      P[j * stride + i] = kept[static_cast<std::size_t>(j)] + R * K[i] * K[j];
  }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < j; ++i) {
      double &above = P[j * stride + i], &below = P[i * stride + j];
      above = below = 0.5 * (above + below);
    }
}

}  // namespace proofmass::estimate
