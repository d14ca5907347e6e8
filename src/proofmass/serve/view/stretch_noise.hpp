#pragma once

#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::serve {

/// Samples that are analysed at once, within a second or so.
inline constexpr std::size_t most_stretch_samples = 2'000'000;

/// The page of `noise` (report/page/json.hpp) of a recording of one channel, in SI where the unit
/// is known. Errors: those of characterise::analyse_noise() and signal::even_grid().
[[nodiscard]] Result<std::string> stretch_noise(const Recording& recording);

}  // namespace proofmass::serve
