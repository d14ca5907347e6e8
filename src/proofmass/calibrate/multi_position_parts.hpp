#pragma once

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/norm_model.hpp"

// What the ways to calibrate have in common.
namespace proofmass::calibrate {

inline constexpr const char* noise_missing =
    "the noise of the means is not known and no position is to spare: their share of the "
    "uncertainty is missing; record more positions";

/// Gravity that is greater by a part makes all scales smaller by that part.
[[nodiscard]] UncertaintyShare gravity_share(const Parameters& estimate,
                                             const MultiPositionOptions& options);

/// Sets the estimates, in the reading's unit, and from the shares their covariance.
void set_estimate(const Parameters& estimate, bool with_misalignment, MultiPosition& out);

/// Sets the root mean squares from the residuals of the poses that were used.
void set_residual_sums(MultiPosition& out);

}  // namespace proofmass::calibrate
