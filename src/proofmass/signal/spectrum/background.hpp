#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/signal/spectrum.hpp"

namespace proofmass::signal {

/// The first bin that is evaluated: those below are raised by the window's main lobe about the mean
/// and by leakage. The bin at half the rate is excluded as well; it has half the degrees of
/// freedom.
inline constexpr std::size_t first_judged_bin = 4;
[[nodiscard]] inline std::size_t end_of_judged_bins(const Spectrum& spectrum) {
  return spectrum.one_sided_psd.size() - 1;
}

/// Adjacent bins of a Hann window are correlated: the mean of n bins has n / 1.94 times the degrees
/// of freedom of one. 1.94 = 1 + 2 (4/9 + 1/36).
inline constexpr double bins_per_independent_bin = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);

/// The smooth background of the spectrum, one value per bin. In log-log scale a parabola is fitted
/// about each bin by least absolute deviations, over an octave and a half on either side, to the
/// medians of groups of bins an eighth of an octave wide (at least three bins). Bins that are
/// `left_out` are excluded. Medians are divided by that of χ²/edf, so that the level is that of the
/// mean.
///
/// Source: W. S. Cleveland, "Robust locally weighted regression and smoothing scatterplots", J. Am.
/// Stat. Assoc. 74 (1979) 829, with absolute deviations instead of his weights.
/// Needs 33 bins.
[[nodiscard]] std::vector<double> spectral_background(const Spectrum& spectrum,
                                                      const std::vector<bool>& left_out);

}  // namespace proofmass::signal
