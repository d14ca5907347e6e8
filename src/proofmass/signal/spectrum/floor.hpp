#pragma once

#include <vector>

#include "proofmass/signal/spectral_lines.hpp"

namespace proofmass::signal {

/// The lowest level that a spectrum keeps for an octave: the bias-corrected median of the bins of
/// the lowest octave below 0.8 of half the rate whose background is flat within 2 dB, lines
/// excluded. If none is flat enough, the flattest one.
[[nodiscard]] SpectralFloor measure_floor(const Spectrum& spectrum,
                                          const std::vector<double>& background,
                                          const std::vector<bool>& in_line);

}  // namespace proofmass::signal
