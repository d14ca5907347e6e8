#pragma once

#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/characterise/noise_search.hpp"

// What a finished search says of each coefficient.
namespace proofmass::characterise {

/// The coefficient whose square is the strength of a column: value, standard deviation, verdict and
/// likelihood-ratio intervals.
[[nodiscard]] Coefficient strength_coefficient(const Search& search, int column);

/// The ramp's.
[[nodiscard]] Coefficient ramp_coefficient(const Search& search);

}  // namespace proofmass::characterise
