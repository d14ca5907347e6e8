#pragma once

#include <cstddef>
#include <string>

#include "proofmass/characterise/allan/statistic.hpp"

namespace proofmass::characterise {

/// Ratio of the expectation of a variance estimate to the true variance, for a rate spectrum f^α;
/// divide an estimate by it:
///
///     totdev            1 − a τ/T          a = 0, 1/(3 ln 2), 3/4  of α = 0, −1, −2
///                       1 + b τ/T          b = 4/3, 0.87           of α = 2, 1
///     mtotdev ttotdev   0.94, 0.83, 0.73, 0.70, 0.69               of α = 2, 1, 0, −1, −2
///     htotdev           0.995, 0.851, 0.771, 0.717, 0.679          of α = 0, −1, −2, −3, −4; m > 1
///                       1.385 − 0.28/m, 1.25 − 0.25/m              of α = 2, 1; m > 1
///     theo1             1 / (a + b/m^c)                            1 for α = 0
///                       1/m + Σ 1/k, k = 1 … m/2                   of α = 2
///
/// with τ/T = m/(N − 1), N the number of phase points.
///
/// - The values of totdev, htotdev and theo1 for α = 2, and of totdev and htotdev for α = 1, are
///   unpublished. For α = 2 they are the exact expectations in white phase noise (for htotdev a fit
///   to them, for even m), for α = 1 fits to the expectations in flicker phase noise, within 0.06.
/// - The ratio is 1 for all other statistics, and for power laws missing in a table.
/// - The true variance of theo1 is the Allan variance at 0.75 m τ0.
///
/// Source: W. J. Riley, NIST SP 1065 (2008), sections 5.2.11–5.2.15 and 5.4; D. A. Howe, Total
/// variance explained, Proc. EFTF–IEEE IFCS (1999), table 1; D. A. Howe et al., A total estimator
/// of the Hadamard function used for GPS operations, Proc. 32nd PTTI (2000); D. A. Howe, T. N.
/// Tasset, Theo1: characterization of very long-term frequency stability, Proc. 18th EFTF (2004).
/// Needs: −4 ≤ α ≤ 2, 1 ≤ m < N.
[[nodiscard]] double variance_bias(Statistic statistic,
                                   int alpha,
                                   std::size_t m,
                                   std::size_t phase_points);

/// Description of the correction by variance_bias; empty if there is none.
[[nodiscard]] std::string bias_correction(Statistic statistic);

}  // namespace proofmass::characterise
