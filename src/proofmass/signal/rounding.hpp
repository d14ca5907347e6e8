#pragma once

#include <vector>

// What quantisation leaves in a mean.
namespace proofmass::signal {

/// Variance of the error of a mean of quantised measurements:
///
/// - step²/12 without noise;
/// - with Gaussian noise σ, at most (step/π) e^(−2π²(σ/step)²), sinusoidal in the mean; σ is that
///   of the shares of the codes, less two standard deviations, or of the variance if that is less;
/// - with an additional sine of amplitude A, |J₀(2πA/step)| ≤ (1/π) √(step/A) of that. Both act as
///   dither.
/// - step²/12 if all but 2 in 1000 measurements have one of two codes.
///
/// Source: B. Widrow, I. Kollár, Quantization Noise (2008), chapter 5 and appendix G.
[[nodiscard]] double rounding_variance(std::vector<double> values, double step);

}  // namespace proofmass::signal
