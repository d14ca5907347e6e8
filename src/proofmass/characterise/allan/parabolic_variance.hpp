#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// Parabolic variance of a phase record x of N points τ0 apart and without NaN: half the mean
/// square difference of the least-squares slopes of adjacent stretches of τ = m τ0,
///
///     σ² = 72 / (M m⁴ τ²) · Σ_i (Σ_k ((m−1)/2 − k) (x[i+k] − x[i+m+k]))²,   k = 0 … m − 1,
///
/// i = 0 … M − 1, M = N − 2m; at m = 1, where a stretch has no slope, the Allan variance. The
/// factor is the published one, exact for large m: a steady drift gives ((m² − 1)/m²)² of its
/// variance. A constant rate changes nothing. Source: F. Vernotte, M. Lenczner, P.-Y. Bourgeois, E.
/// Rubiola, The parabolic variance (PVAR), IEEE Trans. UFFC 63 (2016) 611; E. Benkler, C. Lisdat,
/// U. Sterr, On the relation between uncertainties of weighted frequency averages and the various
/// types of Allan deviations, Metrologia 52 (2015) 565. m from 1 to (N − 1)/2; the terms are the M
/// differences. Cost: O(N) for any m; allocates 2 N doubles.
[[nodiscard]] PhaseVariance parabolic_variance(View<double> phase, double tau0_s, std::size_t m);

}  // namespace proofmass::characterise
