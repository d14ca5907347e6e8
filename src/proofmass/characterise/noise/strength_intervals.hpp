#pragma once

#include "proofmass/characterise/noise/search.hpp"
#include "proofmass/characterise/noise_model.hpp"

// Results of a finished search for each coefficient.
namespace proofmass::characterise {

/// The coefficient whose square is the strength of a column: value, standard deviation, verdict and
/// likelihood-ratio intervals.
[[nodiscard]] Coefficient strength_coefficient(const Search& search, int column);

/// Sets the standard deviation of an identified coefficient to the longer side of its interval over
/// 1.96. For a slow term that is the upper one if few ordinates show it, and the lower one if
/// another term could replace it.
void set_std_of_longer_side(Coefficient& found);

/// The coefficient of the ramp.
[[nodiscard]] Coefficient ramp_coefficient(const Search& search);

/// The ramp after a wave was subtracted: from the remaining slope, by Student's t.
[[nodiscard]] Coefficient ramp_coefficient(const Uncertain& slope_per_s);

}  // namespace proofmass::characterise
