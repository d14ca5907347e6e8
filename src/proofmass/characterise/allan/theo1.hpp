#pragma once

#include <cstddef>

#include "proofmass/characterise/allan/phase_variance.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::characterise {

/// Theo1, a variance that reaches averaging times of three quarters of a record, from a phase
/// record x of N points τ0 apart and without NaN:
///
///     σ²(0.75 m τ0) = Σ_i Σ_l (x[i] − x[i+l] − x[i+m−l] + x[i+m])² / l / (0.75 (N−m) (m τ0)²),
///
/// i = 0 … N − m − 1 and l = 1 … m/2. A constant rate, however large, changes nothing. Source: D.
/// A. Howe, T. K. Peppler, Very long-term frequency stability: estimation using a special-purpose
/// statistic, IEEE IFCS 2003; W. J. Riley, NIST SP 1065 (2008), section 5.2.15. m even, from 2 to N
/// − 1; the published range begins at 10. The terms are the squared differences used: all (N − m)
/// m/2 where N m ≤ 4·10⁷; beyond, i advances in steps of m/16 at most, which reduces the degrees of
/// freedom substantially, but only for white phase noise. Cost: O(N m), but at most 4·10⁷ or 16 N
/// times a few operations; allocates N + m/2 doubles.
[[nodiscard]] PhaseVariance theo1(View<double> phase, double tau0_s, std::size_t m);

}  // namespace proofmass::characterise
