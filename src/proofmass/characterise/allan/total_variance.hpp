#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/core/view.hpp"

// The total variances extend a record, or each stretch of it, by its mirror image, and so stay
// precise up to averaging times near the record's length. All take a phase record x, the sum of the
// rates times τ0 starting with 0, of N points τ0 apart and without NaN; τ = m τ0. A constant rate,
// however large, does not affect them.
namespace proofmass::characterise {

/// Total variance:
///
///     σ² = Σ (x*[i−m] − 2 x*[i] + x*[i+m])² / (2 τ² (N − 2)),   i = 1 … N − 2,
///
/// where x* is x, continued by x*[−j] = 2 x[0] − x[j] and x*[N−1+j] = 2 x[N−1] − x[N−1−j].
/// Source: W. J. Riley, NIST SP 1065 (2008), section 5.2.11.
/// m from 1 to N − 1; the terms are the N − 2 differences. Cost: O(N); allocates N doubles.
[[nodiscard]] PhaseVariance total_variance(View<double> phase, double tau0_s, std::size_t m);

/// Modified total variance: each stretch of 3m points of phase, minus the straight line through the
/// means of its halves, is continued at both ends by its mirror image, not inverted, and
///
///     σ² = mean over the stretches of mean of (x̄*[j] − 2 x̄*[j+m] + x̄*[j+2m])² / (2 τ²),
///
/// over the 6m second differences, each from its own j, of the means x̄* of m points. The time total
/// variance is this · τ²/3. Source: W. J. Riley, NIST SP 1065 (2008), section 5.2.12. 3m from 3 to
/// N; the terms are the stretches used: all N − 3m + 1 where N m ≤ 4·10⁷; beyond, one begins every
/// few samples only, 16 or more of them in each τ. Cost: O(N m), but at most 4·10⁷ or 16 N times a
/// few operations; allocates 13 m doubles.
[[nodiscard]] PhaseVariance modified_total_variance(View<double> phase,
                                                    double tau0_s,
                                                    std::size_t m);

/// Hadamard total variance: as the modified total variance, with the N − 1 rates instead of the
/// phase and their mean second differences divided by 6 instead of 2 τ². At m = 1, where three
/// rates minus their slope no longer measure the drift, it is the overlapping Hadamard variance, as
/// in NIST's own tables, and then unbiased. Source: W. J. Riley, NIST SP 1065 (2008), section
/// 5.2.14. 3m from 3 to N − 1; the terms are the stretches used, of N − 3m, with the same stride
/// (which reduces degrees of freedom for white phase only). Cost: as the modified total variance,
/// and N doubles more.
[[nodiscard]] PhaseVariance hadamard_total_variance(View<double> phase,
                                                    double tau0_s,
                                                    std::size_t m);

}  // namespace proofmass::characterise
