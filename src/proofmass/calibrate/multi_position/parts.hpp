#pragma once

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"

// Shared by the calibration methods.
namespace proofmass::calibrate {

inline constexpr const char* noise_missing =
    "the noise of the means is not known and no position is to spare: their share of the "
    "uncertainty is missing; record more positions";

/// If gravity is greater by a fraction, all scales are smaller by that fraction.
[[nodiscard]] UncertaintyShare gravity_share(const Parameters& estimate,
                                             const MultiPositionOptions& options);

/// Sets the estimates, in the output's unit, and their covariance from the shares.
void set_estimate(const Parameters& estimate, bool with_misalignment, MultiPosition& out);

/// Sets the root mean squares from the residuals of the poses used.
void set_residual_sums(MultiPosition& out);

}  // namespace proofmass::calibrate
