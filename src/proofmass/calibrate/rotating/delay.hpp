#pragma once

#include "proofmass/calibrate/rotating/results.hpp"

// Delay of the sensor's output relative to an encoder's angle.
namespace proofmass::calibrate {

/// Whether the speed varies enough, by a fifth of its rms or in both senses of rotation, to
/// separate a delay from a misalignment.
void judge_delay(RotationState& state);

/// A filter of one pole, 1/(1 + s τ), delays the output by τ to second order in ω τ and reduces its
/// amplitude by ½ (ω τ)²:
///
///     C1 = K1 g (δ − τ φ̇),   S1 = K1 g (1 − ½ τ² φ̇²).
///
/// If the bandwidth is stated, or τ fitted, both are corrected. Otherwise their size at
/// assumed_delay_std_s is added to the bounds, with a note.
void allow_for_delay(const RotationState& state,
                     const RotationOptions& options,
                     RotationEstimate& estimate,
                     RotationFit& fit);

}  // namespace proofmass::calibrate
