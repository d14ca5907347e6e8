#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/signal/spectrum.hpp"

namespace proofmass::signal {

/// The bins that are judged: those below are lifted by the window's main lobe about the mean and by
/// what leaks from below, and the one at half the rate has half the degrees of freedom.
inline constexpr std::size_t first_judged_bin = 4;
[[nodiscard]] inline std::size_t end_of_judged_bins(const Spectrum& spectrum) {
  return spectrum.one_sided_psd.size() - 1;
}

/// Neighbouring bins of a Hann window correlate: the mean of n bins has n / 1.94 times the degrees
/// of freedom of one. 1.94 = 1 + 2 (4/9 + 1/36).
inline constexpr double bins_per_independent_bin = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// The spectrum without what stands out of it, one value a bin: in log-log scale a parabola is
/// fitted about each place by least absolute deviations, over an octave and a half to either side,
/// to the medians of groups of bins an eighth of an octave wide (three bins at least). Bins that
/// are `left_out` take no part. Medians are divided by that of χ²/edf, so that the level is that of
/// the mean.
///
/// Source: W. S. Cleveland, "Robust locally weighted regression and smoothing scatterplots", J. Am.
/// Stat. Assoc. 74 (1979) 829, with absolute deviations instead of his weights.
/// Needs 33 bins.
[[nodiscard]] std::vector<double> spectral_background(const Spectrum& spectrum,
                                                      const std::vector<bool>& left_out);

}  // namespace proofmass::signal
