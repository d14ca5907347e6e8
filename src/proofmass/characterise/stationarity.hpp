#pragma once

#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/spectral_lines.hpp"

namespace proofmass::characterise {

/// Whether the noise of a recording is the same from its beginning to its end.
struct Stationarity {
  bool tested = false;     ///< false: too short for any of the tests
  bool stationary = true;  ///< also where the change is real but below `relevant_change`
  double p = 1.0;          ///< that stationary noise departs as far, over all tests together
  /// The test that departs most: differences of means over averaging_s, or the line at line_hz.
  double averaging_s = 0.0;
  std::optional<double> line_hz;
  /// Level there in equal parts of the recording, over its mean: 1.0, 1.0, 2.1, 2.0.
  std::vector<double> relative_level;
};

/// Changes of the level by less, root mean square, are no reason to call the noise another.
inline constexpr double relevant_change = 0.01;

/// Tests the variance at every octave of averaging times, and the amplitude of every line, for
/// changes over time.
///
/// With d_k the differences of neighbouring means over m samples, not overlapping, m = 1, 2, 4 …
/// (Haar wavelet coefficients: independent of one another in white noise and in a random walk,
/// nearly so between) where lines have no part in them, and the Fourier coefficients of blocks at
/// the frequency of each line, the roots √|d_k| are nearly normal. They are averaged over up to 128
/// equal spans of the recording, fewer where neighbouring spans correlate, and an analysis of
/// variance compares 2, 4, 8, 16 and 32 equal parts of it. The scatter of the spans within the
/// parts is the yardstick: heavy tails, rounding and correlation are in it. All probabilities are
/// multiplied by the number of tests (Bonferroni); below 0.005 the noise is not stationary.
///
/// Source: D. B. Percival, A. T. Walden, Wavelet Methods for Time Series Analysis (2000), sections
/// 8.6 and 9.6 (wavelet variance, homogeneity of variance); H. Levene, Robust tests for equality of
/// variances, in: Contributions to Probability and Statistics (1960), for the analysis of variance
/// of absolute values.
/// NaN is missing. Cost: O(N) for each octave and line.
[[nodiscard]] Stationarity test_stationarity(View<double> series,
                                             double rate_hz,
                                             const std::vector<signal::SpectralLine>& lines);

}  // namespace proofmass::characterise
