#pragma once

#include <optional>

#include "proofmass/characterise/noise/search.hpp"

// A slow deterministic change, which resembles a random walk: one sine with up to a few periods in
// the recording, such as from temperature, or a part of one, which approximates a curved trend.
namespace proofmass::characterise {

/// The sine of 0.2 to 6 periods in the recording that explains the lowest coefficients best,
/// together with a ramp and the columns `active`: for each frequency the amplitudes by generalised
/// least squares, weighted by the density of the fit without slow terms or of the current fit,
/// whichever gives the higher likelihood. nullopt if there are too few coefficients.
[[nodiscard]] std::optional<SlowWave> best_slow_wave(const Search& search, double duration_s);

/// The slope of evidence without a wave of this frequency, with the uncertainty of a ramp fitted
/// together with such a wave: with less than a period they are hardly separable.
[[nodiscard]] Uncertain slope_beside_wave(const Search& search, double frequency_hz);

/// Whether a column is no longer needed after a wave is subtracted.
[[nodiscard]] bool wave_may_stand_for(const Search& search, const SlowWave& wave, int column);

}  // namespace proofmass::characterise
