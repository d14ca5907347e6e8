#pragma once

#include <cstddef>

// The loops in which nearly all the time of a deviation curve goes, compiled for the vector units
// of several processors and chosen when the program starts. No fused multiply-add and a fixed order
// of summation: every processor gets the same digits.
namespace proofmass::characterise {

/// Σ (x[i+2m] − 2 x[i+m] + x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_second_differences(const double* x, std::size_t m, std::size_t n);

/// Σ (x[i+3m] − 3 x[i+2m] + 3 x[i+m] − x[i])² over i = 0 … n − 1.
[[nodiscard]] double squared_third_differences(const double* x, std::size_t m, std::size_t n);

}  // namespace proofmass::characterise
