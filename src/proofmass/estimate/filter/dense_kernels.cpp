#include "proofmass/estimate/filter/dense_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

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

// Otherwise GCC makes the loop a call of memcpy().
#if defined(__GNUC__) && !defined(__clang__)
#define PM_LOOP_OF_STORES [[gnu::optimize("no-tree-loop-distribute-patterns")]]
#else
#define PM_LOOP_OF_STORES
#endif

PM_VECTOR_CLONES PM_LOOP_OF_STORES void copy_entries(const double* __restrict from,
                                                     double* __restrict to,
                                                     int count) {
  for (int i = 0; i < count; ++i) to[i] = from[i];
}

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

PM_VECTOR_CLONES void four_by_four_times(const double* __restrict F,
                                         const double* __restrict A,
                                         double* __restrict Y,
                                         SquareExtent extent) {
  constexpr std::size_t four = 4 * sizeof(double);
  using Column [[gnu::vector_size(four)]] = double;
  Column f0, f1, f2, f3;
  std::memcpy(&f0, F, four);
  std::memcpy(&f1, F + 4, four);
  std::memcpy(&f2, F + 8, four);
  std::memcpy(&f3, F + 12, four);
  for (int j = 0; j < extent.n; ++j) {
    const double* a = A + j * extent.stride;
    const Column y = ((f0 * a[0] + f1 * a[1]) + f2 * a[2]) + f3 * a[3];
    std::memcpy(Y + 4 * j, &y, four);
  }
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
