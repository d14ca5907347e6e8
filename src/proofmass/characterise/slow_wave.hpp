#pragma once

#include <optional>

#include "proofmass/characterise/noise_search.hpp"

// A slow deterministic change, which looks like a random walk: one sine of up to a few periods in
// the recording, as temperature makes it, or a piece of one, which a trend that bends is near to.
namespace proofmass::characterise {

/// The sine of 0.2 to 6 periods in the recording that explains the lowest coefficients best,
/// together with a ramp and the columns `active`: for each frequency the amplitudes by generalised
/// least squares, weighted by the density of the fit without slow terms or of the fit as it is,
/// whichever leads to the higher likelihood. nullopt where there are too few coefficients.
[[nodiscard]] std::optional<SlowWave> best_slow_wave(const Search& search, double duration_s);

/// The slope of evidence that a wave of this frequency was taken out of, with the uncertainty of a
/// ramp fitted together with such a wave: of less than a period they are hardly to be separated.
[[nodiscard]] Uncertain slope_beside_wave(const Search& search, double frequency_hz);

/// Whether a column is no longer needed once a wave is taken out.
[[nodiscard]] bool wave_may_stand_for(const Search& search, const SlowWave& wave, int column);

}  // namespace proofmass::characterise
