#pragma once

#include "proofmass/calibrate/rotation_results.hpp"

// The delay of the sensor's readings after an encoder's angle.
namespace proofmass::calibrate {

/// Whether the speed varies enough, by a fifth of its rms or in both senses of rotation, to
/// determine a delay beside a misalignment.
void judge_delay(RotationState& state);

/// A filter of one pole, 1/(1 + s τ), delays the readings by τ to second order in ω τ and takes
/// ½ (ω τ)² off their amplitude:
///
///     C1 = K1 g (δ − τ φ̇),   S1 = K1 g (1 − ½ τ² φ̇²).
///
/// With the bandwidth stated, or with τ fitted, both are put right. Else their size at
/// assumed_delay_std_s goes into the bounds, with a note.
void allow_for_delay(const RotationState& state,
                     const RotationOptions& options,
                     RotationEstimate& estimate,
                     RotationFit& fit);

}  // namespace proofmass::calibrate
