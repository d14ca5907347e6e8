#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Autocorrelation of a series of N values at the lags k = 0 … lags:
///
///     r[k] = (1 − k/N) (Σ (x[n] − x̄)(x[n+k] − x̄) / pairs[k]) / (Σ (x[n] − x̄)² / pairs[0]),
///
/// over the pairs with both values finite; others are missing. If none is missing, pairs[k] = N − k
/// and r is the usual Σ (x[n] − x̄)(x[n+k] − x̄) / Σ (x[n] − x̄)². 0 at a lag without a pair; NaN
/// everywhere if the series is constant.
///
/// Source: G. E. P. Box, G. M. Jenkins, G. C. Reinsel, Time Series Analysis (1994), section 2.1.5;
/// for missing values E. Parzen, Sankhyā A 25 (1963) 383.
///
/// Cost: O(N log lags), by transforms of overlapping segments, up to 8192 lags: about 4 ns per
/// value, twice that if any is missing. Beyond, O(N log N) by one transform of all.
[[nodiscard]] std::vector<double> autocorrelation(View<double> series, std::size_t lags);

struct WhitenessOptions {
  double rate_hz;                     ///< sampling rate of the residuals
  double scale_s;                     ///< length of the blocks; 1 / rate_hz for single samples
  std::size_t fitted_parameters = 0;  ///< number of parameters of the fitted model
};

/// Results of three tests on the block means of one scale. Under white noise each p is uniform.
struct WhitenessTest {
  double scale_s = 0.0;                 ///< length of the blocks, a whole number of samples
  std::size_t values = 0;               ///< block means that are not missing
  std::size_t lags = 0;                 ///< largest lag of the autocorrelation
  std::vector<double> autocorrelation;  ///< at lag 1 … lags, in blocks
  double bound = 0.0;                   ///< 1.96/√n: 95 % bound of |r| for white noise
  double inside_bounds = 0.0;           ///< fraction of the lags with |r| ≤ bound
  double ljung_box = 0.0;               ///< Q
  double ljung_box_p = 0.0;             ///< correlation at short lags
  double periodogram_excess = 0.0;      ///< D, largest deviation of the cumulative periodogram
  double periodogram_p = 0.0;           ///< power concentrated in a band: drift, lines, a filter
  double runs_z = 0.0;  ///< standardised number of runs; negative if there are too few
  double runs_p = 0.0;  ///< signs that cluster or alternate, whatever the distribution
  bool white = false;   ///< none of the three is rejected at a joint level of 5 %
};

/// Tests whether the means of successive blocks of the residuals are white.
///
/// A block is missing if half of its samples are; an incomplete block at the end is omitted. On the
/// n block means:
///
///     Q = (n + 2)/n Σ pairs[k] r̃[k]²  ~  χ²(lags − fitted parameters),   r̃ = r / (1 − k/N),
///     lags = min(√n, 1000);
///     D = Kolmogorov's distance of C[j] = Σ_{i ≤ j} I[i] / Σ I[i], j < m, from the distribution
///         of m − 1 uniform values, p at λ = (√(m − 1) + 0.12 + 0.11/√(m − 1)) D,
///         I the m = ⌈n/2⌉ − 1 ordinates of the periodogram between 0 and half the rate;
///     z = (runs − μ)/σ,  μ = 1 + 2ab/n,  σ² = (μ − 1)(μ − 2)/(n − 1),
///         a values above the median and b not above it, or, where that is more even, not below.
///
/// - Q is Ljung and Box's n (n + 2) Σ r²/(n − k) if nothing is missing.
/// - D and z treat the values as consecutive, without the missing ones. For more than 65 536 values
///   I is the sum over segments of 8192, m − 1 their total number of ordinates.
/// - white holds if the smallest of the three p exceeds 5 %/3, the first step of Holm's procedure.
///
/// Power of √n lags, by simulation (7200 s at 1 Hz of white noise with a random walk of 0.005 of
/// its standard deviation in √s):
/// - the random walk is rejected in 91 % of cases, by the usual ten lags (R. J. Hyndman, G.
///   Athanasopoulos, Forecasting (2021), section 5.4) in 77 %;
/// - white noise is rejected in 5 to 6 %, with n/5 or n/4 lags (Box and Jenkins) in up to 9 %;
/// - slower drift is visible at longer scales only.
///
/// Source: G. M. Ljung, G. E. P. Box, Biometrika 65 (1978) 297; D. S. Stoffer, C. M. C. Toloi,
/// Statistics & Probability Letters 13 (1992) 391, for missing values; P. J. Brockwell, R. A.
/// Davis, Time Series: Theory and Methods (1991), section 10.2; M. A. Stephens, J. R. Stat. Soc. B
/// 32 (1970) 115; A. Wald, J. Wolfowitz, Ann. Math. Stat. 11 (1940) 147; S. Holm, Scand. J. Stat. 6
/// (1979) 65.
///
/// Errors: invalid_argument (a rate that is not positive, blocks shorter than a sample),
/// too_few_samples (fewer than 20 blocks, or not more lags than fitted parameters), not_observable
/// (all block means equal), not_finite (squares overflow).
/// Cost: about 10 ns per block mean, twice that if any is missing, and 1 ns per sample.
[[nodiscard]] Result<WhitenessTest> test_whiteness(View<double> residuals,
                                                   const WhitenessOptions& options);

/// Tests at the sample interval and with blocks of 1, 10, 100 … s, as long as there are 30 blocks
/// of two samples or more; empty if no test is possible.
[[nodiscard]] std::vector<WhitenessTest> test_whiteness_at_scales(
    View<double> residuals, double rate_hz, std::size_t fitted_parameters = 0);

}  // namespace proofmass::signal
