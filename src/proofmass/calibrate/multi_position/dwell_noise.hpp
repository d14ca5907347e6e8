#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit/dyadic_allan.hpp"

namespace proofmass::calibrate {

/// Uncertainty of the mean of a rest, from the noise common to all rests.
struct DwellNoise {
  double white = 0.0;        ///< N², of the Allan variance N²/m over m samples
  double flicker = 0.0;      ///< its part that does not depend on m
  double random_walk = 0.0;  ///< its part ∝ m
  double dof = 0.0;          ///< of the variance at the median dwell; 0: there is no noise to see
  double rounding = 0.0;     ///< what the noise does not average out of the steps: lsb²/12 of none

  /// Variance of the mean over `samples`, in the output's unit squared.
  [[nodiscard]] double variance_of_mean(std::size_t samples) const;
};

/// Fits σ²(m) = N²/m + F + K m to the Allan variances of the rests at m = 1, 2, 4, … samples,
///
///     σ²(m) = ½ mean (ȳ_{2k+1} − ȳ_{2k})²
///
/// over neighbouring non-overlapping means of m samples (Haar wavelet), pooled over all rests.
///
/// - Method: non-negative least squares with weights from the fitted values; the coefficients are
///   the mean over the choices of terms (white noise with or without the others) by Akaike weights,
///   with a penalty of 3.84 for each further term.
/// - The uncertainty of a mean over the dwell is σ at the dwell: the difference of two rests of
///   that length, over √2.
/// - `rests` are the samples of one axis, rest by rest; NaN, infinities and spikes must be removed
///   first.
/// - `lsb` is the quantisation step, 0 if none. Normal noise of ρ steps leaves a quantisation
///   variance of lsb² ½ Σ_k (exp(−2π²k²ρ²)/(πk))² in every mean.
///
/// Source: B. Widrow, I. Kollár, Quantization Noise (2008), for rounding; D. W. Allan, Proc. IEEE
/// 54 (1966) 221; D. B. Percival, P. Guttorp, Long-memory processes, the Allan variance and
/// wavelets (1994), for the Haar wavelet; S. T. Buckland, K. P. Burnham, N. H. Augustin, Biometrics
/// 53 (1997) 603, for the weights. Cost: O(N).
[[nodiscard]] DwellNoise fit_dwell_noise(const std::vector<std::span<const double>>& rests,
                                         double lsb);

/// The Allan variances of the rests, m ascending.
[[nodiscard]] std::vector<signal::AllanLevel> allan_levels(
    const std::vector<std::span<const double>>& rests);

/// fit_dwell_noise() from given Allan variances, ascending, with the dwell in samples to which the
/// degrees of freedom refer.
[[nodiscard]] DwellNoise fit_dwell_noise(View<signal::AllanLevel> levels, double dwell, double lsb);

}  // namespace proofmass::calibrate
