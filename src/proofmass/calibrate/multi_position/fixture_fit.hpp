#pragma once

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"

namespace proofmass::calibrate {

/// Nine parameters and the rotation R of the fixture's frame to the sensor's, from poses whose
/// directions d in the fixture are given:
///
///     f = T diag(1/scale) (mean − bias),     |f| = g,     f/|f| = R d.
///
/// - Along the direction only the noise of the mean counts.
/// - Across it, also the uncertainty of the position: a tilt of the same std about either axis in
///   all positions, estimated from these residuals. So rough guesses of the directions do no harm,
///   and exact ones are used fully.
/// - Start: mean = A d + bias by linear least squares, A⁻¹ = Rᵀ T diag(1/scale) by Householder.
///
/// Source: J. Geist, M. Y. Afridi, C. D. McGray, M. Gaitan, J. Res. NIST 122 (2017) 32 (quantities
/// independent of the table); the weights are those of restricted likelihood, D. A. Harville, JASA
/// 72 (1977) 320. Errors: too_few_samples (fewer than 5 poses), invalid_argument (a pose without
/// direction; the directions are the mirror image of the measurements), not_observable (directions
/// in a plane).
[[nodiscard]] Result<MultiPosition> calibrate_given(View<Pose> poses,
                                                    const ReadingScale& scale,
                                                    double noise_dof,
                                                    const MultiPositionOptions& options);

}  // namespace proofmass::calibrate
