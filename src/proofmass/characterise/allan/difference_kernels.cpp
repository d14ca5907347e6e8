#include "proofmass/characterise/allan/difference_kernels.hpp"

#include <array>
#include <numeric>

#include "proofmass/core/vector_clones.hpp"

namespace proofmass::characterise {
namespace {

// Parallel sums, so that additions do not wait for each other.
constexpr std::size_t lanes = 16;
using Lanes = std::array<double, lanes>;

double total(const Lanes& sums) {
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

PM_VECTOR_CLONES
bool all_finite(const double* values, std::size_t n) {
  // One infinity or NaN makes the sum of x·0 a NaN.
  Lanes sums{};
  std::size_t k = 0;
  for (; k + lanes <= n; k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) sums[lane] += values[k + lane] * 0.0;
  for (; k < n; ++k) sums[0] += values[k] * 0.0;
  return total(sums) == 0.0;
}

PM_VECTOR_CLONES
double squared_second_differences(const double* x, std::size_t m, std::size_t n) {
  Lanes sums{};
  const double* middle = x + m;
  const double* last = x + 2 * m;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const double z = (last[i + k] + x[i + k]) - 2.0 * middle[i + k];
      sums[k] += z * z;
    }
  }
  for (; i < n; ++i) {
    const double z = (last[i] + x[i]) - 2.0 * middle[i];
    sums[0] += z * z;
  }
  return total(sums);
}

PM_VECTOR_CLONES
double squared_third_differences(const double* x, std::size_t m, std::size_t n) {
  Lanes sums{};
  const double* second = x + m;
  const double* third = x + 2 * m;
  const double* last = x + 3 * m;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const double z = (last[i + k] - x[i + k]) - 3.0 * (third[i + k] - second[i + k]);
      sums[k] += z * z;
    }
  }
  for (; i < n; ++i) {
    const double z = (last[i] - x[i]) - 3.0 * (third[i] - second[i]);
    sums[0] += z * z;
  }
  return total(sums);
}

}  // namespace proofmass::characterise
