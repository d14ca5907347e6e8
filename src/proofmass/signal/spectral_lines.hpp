#pragma once

#include <vector>

#include "proofmass/signal/spectrum.hpp"

namespace proofmass::signal {

/// The level of a spectrum, read where it is lowest and even.
struct SpectralFloor {
  double one_sided_density = 0.0;  ///< unit/√Hz
  double std = 0.0;                ///< its standard deviation, unit/√Hz
  double low_hz = 0.0;             ///< the band it was read in
  double high_hz = 0.0;
};

/// Power that stands out of the spectrum in a narrow band: a tone, or a resonance.
struct SpectralLine {
  double frequency_hz = 0.0;
  double low_hz = 0.0;  ///< the band its power was summed over
  double high_hz = 0.0;
  double amplitude = 0.0;  ///< of the sine of the same power, √(2 · excess power); in the unit
  double amplitude_std = 0.0;
  double excess_db = 0.0;  ///< its peak above the background
};

struct LineReport {
  SpectralFloor floor;
  std::vector<SpectralLine> lines;  ///< by ascending frequency
  std::vector<double> background;   ///< PSD without the lines, unit²/Hz, one a bin
  std::vector<bool> in_line;        ///< one a bin
};

/// Finds the lines of a spectrum, its smooth background and its white floor.
///
/// A line begins where the PSD over the background exceeds the quantile of χ²/edf that noise alone
/// exceeds in one spectrum of a thousand (Bonferroni over the bins), and 1 dB at least. It goes on
/// to either side while the mean over five bins exceeds its 95 % quantile; lines that touch are
/// one. It must be narrower than an octave at half its height, and higher than what lies on both
/// sides of it. Its amplitude is √(2 Σ (PSD − background) Δf); a resonance's far skirts are lost in
/// the background, 5 to 7 % of its amplitude. The standard deviation takes a line of three bins or
/// fewer for a steady tone in noise, a wider one for a resonance that noise shakes.
///
/// The background is a robust parabola in log-log scale over three octaves: red and white noise and
/// their corners pass, so do filters of one or two poles. A filter of four poles close to half the
/// rate can show a line at its edge in a spectrum of few segments.
///
/// The floor is the lowest level that the spectrum keeps for an octave, even within 2 dB, below 0.8
/// of half the rate: the median of its bins, corrected for its bias. A filter whose roll-off begins
/// in that octave lowers it by up to a fifth.
///
/// Below 33 bins nothing is looked for: the background is the spectrum, the floor zero.
/// Cost: about 3 ms for 2049 bins.
[[nodiscard]] LineReport find_lines(const Spectrum& spectrum);

}  // namespace proofmass::signal
