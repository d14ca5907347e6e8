#pragma once

#include "proofmass/calibrate/rotating/pass.hpp"
#include "proofmass/calibrate/rotation.hpp"

// Notes on a fit to a rotating wheel.
namespace proofmass::calibrate {

/// √2 times the rms residual of an axis, over the amplitude of gravity.
[[nodiscard]] double relative_residual(const RotationState& state, std::size_t axis);

/// Why the recording may not be a bench test.
void note_doubts(const RotationState& state, const RotationOptions& options, RotationFit& fit);

/// What the encoder's zero leaves undetermined.
void note_zero(const RotationState& state, RotationFit& fit);

/// The estimated ripples, and the effect of one attributed to the sensor.
void note_ripples(const RotationOptions& options, RotationFit& fit);

}  // namespace proofmass::calibrate
