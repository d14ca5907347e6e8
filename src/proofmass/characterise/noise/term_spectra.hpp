#pragma once

#include <cstddef>

#include "proofmass/characterise/noise_model.hpp"

// Two-sided power spectral densities, in unit²/Hz, of the terms of the noise model with coefficient
// 1, after sampling.
namespace proofmass::characterise {

/// Averaging of the series of a spectrum: means over `block` samples.
struct Sampling {
  double rate_hz = 0.0;   ///< of the samples
  std::size_t block = 1;  ///< samples averaged to one value
  [[nodiscard]] double step_s() const { return static_cast<double>(block) / rate_hz; }
};

/// Density of one term at 0 < f ≤ 1/(2 step):
///
///     quantisation   4 sin²(ω/2) / h                              ω = 2π f h, h the step
///     white          1
///     flicker        τ0 / (2 sin(π f τ0))                         by the means' transfer and
///     aliases random walk    h τ0 [(2D² + 1)/(3D) + (D² − 1)/(3D) cos ω] / (4 sin²(ω/2))      D
///     the block
///
/// Source: of means of a random walk H. Working, Note on the correlation of first differences of
/// averages in a random chain, Econometrica 28 (1960) 916; of flicker N. J. Kasdin, Discrete
/// simulation of colored noise and stochastic processes, Proc. IEEE 83 (1995) 802.
/// Term::markov needs its time constant: relaxation_density.
[[nodiscard]] double term_density(Term term, double frequency_hz, const Sampling& sampling);

/// Density of an exponentially correlated process, sampled and averaged, with density 1 at
/// frequency zero: 1 / (1 + (2π f T)²) except for aliases; the closed form of the means'
/// autocovariance.
[[nodiscard]] double relaxation_density(double time_constant_s,
                                        double frequency_hz,
                                        const Sampling& sampling);

/// Allan variance at τ = m/rate of the same process, as sampled: the difference of the variance of
/// the means over m samples and of their covariance with the next.
[[nodiscard]] double relaxation_allan_variance(double time_constant_s, double m, double rate_hz);

}  // namespace proofmass::characterise
