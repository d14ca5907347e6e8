#pragma once

#include <vector>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/view.hpp"

// Variation of nonstationary noise within a recording.
namespace proofmass::characterise {

/// The model of each of eight equal parts, or of four if an eighth is too short; empty if a quarter
/// is.
[[nodiscard]] std::vector<NoisePart> noise_of_parts(View<double> series,
                                                    const NoiseOptions& options);

/// Widens the intervals of those coefficients that differ significantly between the parts (χ² of
/// their differences at one in a thousand) to span those of the parts, with their standard
/// deviations; the values stay those of the whole recording.
void widen_to_parts(const std::vector<NoisePart>& parts, NoiseModelFit& model);

}  // namespace proofmass::characterise
