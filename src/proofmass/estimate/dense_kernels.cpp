#include "proofmass/estimate/dense_kernels.hpp"

#include "proofmass/core/vector_clones.hpp"

namespace proofmass::estimate {

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
    // A reading hangs on few of the states.
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

}  // namespace proofmass::estimate
