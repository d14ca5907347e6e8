#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/statistic.hpp"

// Which differences a deviation takes, and the inner loops over them, compiled for the vector units
// of several processors and selected at program start. No fused multiply-add and a fixed order of
// summation: results are identical on every processor.
namespace proofmass::characterise {

/// Whether the differences are of phases averaged over τ.
[[nodiscard]] inline bool is_modified(Statistic statistic) {
  return statistic == Statistic::mdev || statistic == Statistic::tdev;
}

/// 2 or 3: the order of the differences of the phase.
[[nodiscard]] inline std::size_t order_of(Statistic statistic) {
  return statistic == Statistic::adev || statistic == Statistic::oadev ? 2 : 3;
}

[[nodiscard]] bool all_finite(const double* values, std::size_t n);

/// Σ (x[i+2m] − 2 x[i+m] + x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_second_differences(const double* x, std::size_t m, std::size_t n);

/// Σ (x[i+3m] − 3 x[i+2m] + 3 x[i+m] − x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_third_differences(const double* x, std::size_t m, std::size_t n);

}  // namespace proofmass::characterise
