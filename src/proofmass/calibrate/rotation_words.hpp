#pragma once

#include "proofmass/calibrate/rotation.hpp"
#include "proofmass/calibrate/rotation_pass.hpp"

// What is said about a fit to a turning wheel.
namespace proofmass::calibrate {

/// √2 rms of what an axis's fit leaves, over the amplitude of gravity's turn.
[[nodiscard]] double relative_residual(const RotationState& state, std::size_t axis);

/// Why the recording may be no test on a bench.
void note_doubts(const RotationState& state, const RotationOptions& options, RotationFit& fit);

/// The ripples that were found, and the effect of one that is put down to the sensor.
void note_ripples(const RotationOptions& options, RotationFit& fit);

}  // namespace proofmass::calibrate
