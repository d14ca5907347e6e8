#pragma once

#include <cstddef>

// The loops over all samples of the stationarity test, compiled for the vector units of several
// processors. A fixed order of summation gives the same digits on all of them.
namespace proofmass::characterise {

/// Splits `pairs` pairs of neighbouring values into their differences, second − first, and means.
void split_pairs(const double* values, std::size_t pairs, double* differences, double* means);

struct PresentSum {
  double sum = 0.0;
  std::size_t count = 0;
};

/// Sum and number of the values that are not NaN.
[[nodiscard]] PresentSum sum_present(const double* values, std::size_t n);

/// Σ x² of the values whose square is finite.
[[nodiscard]] PresentSum sum_finite_squares(const double* values, std::size_t n);

/// Replaces each value x with √|x|.
void take_roots(double* values, std::size_t n);

}  // namespace proofmass::characterise
