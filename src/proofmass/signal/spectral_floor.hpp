#pragma once

#include <vector>

#include "proofmass/signal/spectral_lines.hpp"

namespace proofmass::signal {

/// The lowest level that a spectrum keeps for an octave: the median, corrected for its bias, of the
/// bins of the octave below 0.8 of half the rate that is lowest among those whose background is
/// even within 2 dB; lines are left out. Where none is so even, the most even one.
[[nodiscard]] SpectralFloor measure_floor(const Spectrum& spectrum,
                                          const std::vector<double>& background,
                                          const std::vector<bool>& in_line);

}  // namespace proofmass::signal
