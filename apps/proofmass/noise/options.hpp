#pragma once

#include "noise/command.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

namespace proofmass::app {

/// What the flags say to the analysis; the rate is the series'. Throws Failure.
[[nodiscard]] characterise::NoiseOptions noise_options(const NoiseCommand& command);

}  // namespace proofmass::app
