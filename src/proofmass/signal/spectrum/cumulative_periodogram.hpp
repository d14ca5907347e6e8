#pragma once

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

struct PeriodogramTest {
  double excess = 0.0;  ///< D of whiteness.hpp
  double p = 0.0;
};

/// Deviation of the cumulative periodogram of ten or more finite values, not all equal, from that
/// of white noise; see whiteness.hpp. For up to 65 536 values it uses the first n' ≤ n, n' the
/// largest number without a prime factor above 31, because the transform is slow otherwise.
/// Cost: O(n log n).
[[nodiscard]] PeriodogramTest test_cumulative_periodogram(View<double> series, double mean);

/// P(D √n > λ) of Kolmogorov's distance D for n → ∞: 2 Σ (−1)^(j−1) exp(−2 j² λ²), j = 1, 2, …
/// Source: N. Smirnov, Ann. Math. Stat. 19 (1948) 279.
[[nodiscard]] double kolmogorov_p(double lambda);

}  // namespace proofmass::signal
