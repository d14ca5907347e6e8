#include "proofmass/characterise/noise/series_kernels.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "proofmass/core/vector_clones.hpp"

namespace proofmass::characterise {
namespace {

// Parallel sums, so that additions do not wait for each other.
constexpr std::size_t lanes = 8;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

[[gnu::always_inline]] inline void load(Lanes& out, const double* values) {
  std::memcpy(&out, values, sizeof(Lanes));
}

[[gnu::always_inline]] inline double total(const Lanes& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

}  // namespace

PM_VECTOR_CLONES
void split_pairs(const double* __restrict values,
                 std::size_t pairs,
                 double* __restrict differences,
                 double* __restrict means) {
  for (std::size_t k = 0; k < pairs; ++k) {
    const double first = values[2 * k], second = values[2 * k + 1];
    differences[k] = second - first;
    means[k] = 0.5 * (second + first);
  }
}

PM_VECTOR_CLONES
PresentSum sum_present(const double* values, std::size_t n) {
  Lanes sums{}, counts{};
  std::size_t k = 0;
  for (; k + lanes <= n; k += lanes) {
    Lanes x;
    load(x, values + k);
    const auto present = x == x;  // NOLINT(misc-redundant-expression): false for NaN
    sums += present ? x : Lanes{};
    counts += present ? Lanes{} + 1.0 : Lanes{};
  }
  PresentSum out{total(sums), static_cast<std::size_t>(total(counts))};
  for (; k < n; ++k) {
    if (std::isnan(values[k])) continue;
    out.sum += values[k];
    ++out.count;
  }
  return out;
}

PM_VECTOR_CLONES
PresentSum sum_finite_squares(const double* values, std::size_t n) {
  constexpr double most = std::numeric_limits<double>::max();
  Lanes sums{}, counts{};
  std::size_t k = 0;
  for (; k + lanes <= n; k += lanes) {
    Lanes x;
    load(x, values + k);
    const Lanes squared = x * x;
    const auto finite = squared <= most;
    sums += finite ? squared : Lanes{};
    counts += finite ? Lanes{} + 1.0 : Lanes{};
  }
  PresentSum out{total(sums), static_cast<std::size_t>(total(counts))};
  for (; k < n; ++k) {
    const double squared = values[k] * values[k];
    if (!std::isfinite(squared)) continue;
    out.sum += squared;
    ++out.count;
  }
  return out;
}

PM_VECTOR_CLONES
void take_roots(double* values, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) values[k] = std::sqrt(std::abs(values[k]));
}

}  // namespace proofmass::characterise
