#pragma once

#include <array>
#include <cstddef>

#include "proofmass/characterise/allan/statistic.hpp"

namespace proofmass::characterise {

/// Parameters of the degrees of freedom of a variance of differences of order d.
struct EdfCase {
  int alpha = 0;      ///< exponent of the rate's spectrum, S_y(f) ∝ f^α: 2 down to 2 − 2d
  int d = 2;          ///< 1: first differences, 2: Allan, 3: Hadamard
  std::size_t m = 1;  ///< averaging factor, τ = m τ0
  std::size_t phase_points = 0;  ///< N, one more than the number of rates
  std::size_t stride = 1;  ///< samples between the starts of terms: 1 is full overlap, m is none
  bool modified = false;   ///< whether each term is averaged over m starts
  /// Whether the power law holds from sample to sample, as for white noise with independent
  /// samples, instead of for a phase averaged over each sample, as in the paper.
  bool sampled = false;
};

/// Equivalent degrees of freedom of the mean square of M differences z of order d:
///
///     1/edf = Σ_{|j|<M} (1 − |j|/M) s_z(j/S)² / (M s_z(0)²),
///
/// where S = m/stride, M = 1 + ⌊(N − L)/stride⌋, L = m d + (modified ? m : 1), and s_z is the
/// autocovariance of z, t in units of τ:
///
///     s_z(t) = Σ_k (−1)^k C(2d, d+k) s_x(t + k),  k = −d … d
///     s_x(t) = F² [2 s_w(t) − s_w(t − 1/F) − s_w(t + 1/F)],  F = modified ? 1 : m
///     s_w(t) = −|t|, t² ln|t|, |t|³, −t⁴ ln|t|, −|t|⁵, t⁶ ln|t|, |t|⁷  for α = 2, 1, … −4.
///
/// Lags beyond J = min(M, (d+1) S) are omitted. Long sums are taken in blocks of lags that grow
/// with the distance from the kinks of s_z (within 0.1 % of the sum over all lags).
///
/// The paper's phase is averaged over each sample. If the law holds from sample to sample
/// (`sampled`), S_y ∝ (2 sin(π f τ0))^α, the exact s_x with n = 2 − α is, up to a factor,
///
///     |t| Π (t² − (i/m)²),  i = 1 … n/2 − 1                    n even; n = 0: 1 at t = 0, else 0
///     ψ(|t| m + ½) Π (t² − ((i − ½)/m)²),  i = 1 … (n − 1)/2   n odd
///
/// and for modified variances 2 s(t) − s(t − 1) − s(t + 1), with s for n + 2. Relative to the
/// paper's edf of the Allan variance, for α = 0, −1, −2:
///
///     m = 1    0.85   0.91   1.31
///     m = 2    1.05   1.10   1.17
///     m = 5    1.12   1.05   1.03
///     m = 20   1.05   1.01   1.00
///
/// Source: C. A. Greenhall, W. J. Riley, Uncertainty of stability variances based on finite
/// differences, Proc. 35th PTTI (2003). Source, from sample to sample: J. R. M. Hosking, Fractional
/// differencing, Biometrika 68 (1981) 165, theorem 1, without its infinite part. Needs: N ≥ L, and
/// α > 1 − 2d, below which the variance does not converge (the Allan variance for α ≤ −3); the
/// caller ensures both. Cost: O(log m).
[[nodiscard]] double greenhall_riley_edf(const EdfCase& known);

/// Share of each power law in the variance at one τ: [0] for α = +2 … [6] for α = −4.
using AlphaShares = std::array<double, 7>;

/// greenhall_riley_edf() for a mixture of power laws; known.alpha is ignored, shares are relative
/// to their sum. The autocovariance is linear in the spectrum, so s_z(t)/s_z(0) of a mixture is the
/// mean of the pure ones weighted by their shares. Needs: no share where a pure law is not allowed.
[[nodiscard]] double mixed_edf(const EdfCase& known, const AlphaShares& shares);

/// The lowest α for which a statistic converges: −4 for the Hadamard family, −2 for all others.
[[nodiscard]] int lowest_alpha(Statistic statistic);

/// Equivalent degrees of freedom of a statistic over all phase points, at full overlap if it has
/// one; T/τ = N/m, and b, c, b0, b1 depend on α:
///
///     adev oadev mdev tdev hdev ohdev   greenhall_riley_edf
///     totdev                            b T/τ − c;  m = 1: oadev
///     mtotdev ttotdev                   b T/τ − c;  m < 10: mdev
///     htotdev                           T/τ / (b0 + b1 τ/T);  m < 16 or α > 0: see below
///     theo1                             five rational functions of N and 0.75 m
///     pdev                              Greenhall and Riley's sum with parabolic weights
///
/// - htotdev uses the edf of oadev outside its fit, of ohdev if m = 1 or α < −2.
/// - The fits are within 20 % of the exact value from m = 4 to τ = T/10 (totdev at m = 2 is a third
///   too high); towards T/3 those of mtotdev (α < 0: too high) and theo1 may be off by half.
/// - Where another statistic is substituted, and in totdev for α > 0, which uses α = 0, the value
///   is too low rather than too high.
///
/// At least 1. Source: W. J. Riley, NIST SP 1065 (2008), sections 5.4.1–5.4.5; for the weights: F.
/// Vernotte, M. Lenczner, P.-Y. Bourgeois, E. Rubiola, The parabolic variance, IEEE Trans. UFFC 63
/// (2016). Needs: lowest_alpha ≤ α ≤ 2, and room for one term. Cost: O(log m).
[[nodiscard]] double edf(Statistic statistic, int alpha, std::size_t m, std::size_t phase_points);

}  // namespace proofmass::characterise
