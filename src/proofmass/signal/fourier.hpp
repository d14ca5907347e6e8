#pragma once

#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Orthonormal discrete cosine transform of type II of N values, so that Σ X² = Σ x²:
///
///     X[k] = √(2/N) s[k] Σ x[n] cos(π k (2n + 1) / (2N)),   s[0] = 1/√2, else s[k] = 1.
///
/// Source: J. Makhoul, "A fast cosine transform in one and two dimensions", IEEE Trans. ASSP 28
/// (1980) 27, by one complex transform of length N; for an N with a prime factor above 31, L.
/// Bluestein, IEEE Trans. AU 18 (1970) 451.
///
/// Cost: O(N log N) for every N, nine times as much by Bluestein's method; allocates 4 N doubles,
/// or up to 16 N by Bluestein's method.
[[nodiscard]] std::vector<double> cosine_transform(View<double> series);

/// Σ w[k] cos(π k d / N) over k = 0 … N − 1 for d = 0 … N, one complex transform of length 2N.
[[nodiscard]] std::vector<double> cosine_sums(View<double> weights);

}  // namespace proofmass::signal
