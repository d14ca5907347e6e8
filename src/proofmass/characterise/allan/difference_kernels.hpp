#pragma once

#include <cstddef>

// Inner loops of a deviation curve, compiled for the vector units of several processors and
// selected at program start. No fused multiply-add and a fixed order of summation: results are
// identical on every processor.
namespace proofmass::characterise {

/// Σ (x[i+2m] − 2 x[i+m] + x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_second_differences(const double* x, std::size_t m, std::size_t n);

/// Σ (x[i+3m] − 3 x[i+2m] + 3 x[i+m] − x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_third_differences(const double* x, std::size_t m, std::size_t n);

}  // namespace proofmass::characterise
