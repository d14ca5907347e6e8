#pragma once

#include <cstddef>
#include <limits>
#include <optional>

#include "proofmass/core/view.hpp"

namespace proofmass {

/// Value of a missing sample.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] constexpr double square(double x) {
  return x * x;
}

/// Mean, spread and range of the finite values of a series, in one pass.
/// Source: B. P. Welford, Technometrics 4 (1962) 419, for the sum of squares without cancellation.
struct Moments {
  std::size_t count = 0;      ///< finite values seen
  std::size_t nonfinite = 0;  ///< NaN and infinities skipped
  double mean = 0.0;
  double squares = 0.0;  ///< Σ (x − mean)²
  double min = 0.0;
  double max = 0.0;

  void add(double x);
  /// Sample standard deviation (n − 1); 0 for fewer than two values.
  [[nodiscard]] double std() const;
};

[[nodiscard]] Moments moments(View<double> series);

/// The p-quantile of the finite values, p in [0, 1], linear between order statistics (type 7 of
/// Hyndman & Fan, 1996). nullopt if no value is finite. Cost: O(N), allocates a copy.
[[nodiscard]] std::optional<double> quantile(View<double> series, double p);

[[nodiscard]] inline std::optional<double> median(View<double> series) {
  return quantile(series, 0.5);
}

/// Standard deviation of a normal distribution from the median absolute deviation, 1.4826 · MAD: up
/// to half the values may be outliers. nullopt if no value is finite.
[[nodiscard]] std::optional<double> robust_std(View<double> series);

}  // namespace proofmass
