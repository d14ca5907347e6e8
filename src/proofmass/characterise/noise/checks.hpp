#pragma once

#include <cstddef>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/result.hpp"

// Checks of a noise analysis, for a whole series and for one in blocks.
namespace proofmass::characterise {

inline constexpr std::size_t fewest_noise_samples = 3;

/// Errors: invalid_argument.
[[nodiscard]] Status check_options(const NoiseOptions& options);

[[nodiscard]] Error too_few_samples(std::size_t samples);

/// Error for a curve without points.
[[nodiscard]] Error no_time_fits(const NoiseOptions& options, std::size_t samples);

}  // namespace proofmass::characterise
