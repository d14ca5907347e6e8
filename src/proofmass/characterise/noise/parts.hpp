#pragma once

#include <vector>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/core/view.hpp"

// Noise that depends on the part of a recording, or on its events.
namespace proofmass::characterise {

/// The model of each of eight equal parts, or of four if an eighth is too short; empty if a quarter
/// is.
[[nodiscard]] std::vector<NoisePart> noise_of_parts(View<double> series,
                                                    const NoiseOptions& options);

/// Widens the intervals of those coefficients that differ significantly between the parts (χ² of
/// their differences at one in a thousand) to span those of the parts, with their standard
/// deviations; the values stay those of the whole recording.
void widen_to_parts(const std::vector<NoisePart>& parts, NoiseModelFit& model);

/// Widens the intervals that do not contain the value of the recording without its outliers and
/// steps to span that one's interval.
void widen_to_fit_without_events(const NoiseModelFit& without, NoiseModelFit& model);

}  // namespace proofmass::characterise
