#pragma once

#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/characterise/noise_search.hpp"

// What a finished search says of each coefficient.
namespace proofmass::characterise {

/// The coefficient whose square is the strength of a column: value, standard deviation, verdict and
/// likelihood-ratio intervals.
[[nodiscard]] Coefficient strength_coefficient(const Search& search, int column);

/// Sets the standard deviation, of a coefficient that is identified to the longer side of its
/// interval over 1.96. Of a slow term that is the upper one where few ordinates show it, and the
/// lower one where another term might stand in for it.
void set_std_of_longer_side(Coefficient& found);

/// The ramp's.
[[nodiscard]] Coefficient ramp_coefficient(const Search& search);

/// The same where a wave was taken out: from the slope that is left, by Student's t.
[[nodiscard]] Coefficient ramp_coefficient(const Uncertain& slope_per_s);

}  // namespace proofmass::characterise
