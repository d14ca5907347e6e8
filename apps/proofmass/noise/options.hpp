#pragma once

#include "noise/command.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

namespace proofmass::app {

/// Options of the analysis from the flags, except for the rate, which is the series'. Throws
/// Failure.
[[nodiscard]] characterise::NoiseOptions noise_options(const NoiseCommand& command);

}  // namespace proofmass::app
