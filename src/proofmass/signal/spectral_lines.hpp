#pragma once

#include <vector>

#include "proofmass/signal/spectrum.hpp"

namespace proofmass::signal {

/// The white floor of a spectrum, measured where it is lowest and flat.
struct SpectralFloor {
  double one_sided_density = 0.0;  ///< unit/√Hz
  double std = 0.0;                ///< standard deviation, unit/√Hz
  double low_hz = 0.0;             ///< the band of the measurement
  double high_hz = 0.0;
};

/// Excess power in a narrow band of the spectrum: a tone or a resonance.
struct SpectralLine {
  double frequency_hz = 0.0;
  double low_hz = 0.0;  ///< the band of the power sum
  double high_hz = 0.0;
  double amplitude = 0.0;  ///< sine of the same power, √(2 · excess power); in the unit
  double amplitude_std = 0.0;
  double excess_db = 0.0;  ///< its peak relative to the background
};

struct LineReport {
  SpectralFloor floor;
  std::vector<SpectralLine> lines;  ///< by ascending frequency
  std::vector<double> background;   ///< PSD without the lines, unit²/Hz, one per bin
  std::vector<bool> in_line;        ///< one per bin
};

/// Finds the lines of a spectrum, its smooth background and its white floor.
///
/// Lines:
/// - A line begins where the ratio of PSD to background exceeds the χ²/edf quantile with a
///   false-alarm probability of one spectrum in a thousand (Bonferroni over the bins), and at least
///   1 dB. It extends to either side while the mean over five bins exceeds its 95 % quantile;
///   adjacent lines are joined.
/// - It must be narrower than an octave at half its height, and higher than the spectrum on both
///   sides.
/// - Its amplitude is √(2 Σ (PSD − background) Δf). The far skirts of a resonance, 5 to 7 % of its
///   amplitude, are lost in the background.
/// - The standard deviation assumes a steady tone in noise for a line of three bins or fewer, and a
///   resonance driven by noise for a wider one.
///
/// Background: a robust parabola in log-log scale over three octaves. It follows red and white
/// noise and their corners, and filters of one or two poles. A filter of four poles close to half
/// the rate can cause a line at its edge in a spectrum of few segments.
///
/// Floor: the lowest level that the spectrum keeps for an octave, flat within 2 dB, below 0.8 of
/// half the rate: the median of its bins, corrected for its bias. A filter whose roll-off begins in
/// that octave lowers it by up to a fifth.
///
/// Below 33 bins there is no search: the background is the spectrum, the floor zero.
/// Cost: about 3 ms for 2049 bins.
[[nodiscard]] LineReport find_lines(const Spectrum& spectrum);

}  // namespace proofmass::signal
