#pragma once

#include "proofmass/calibrate/multi_position/norm_model.hpp"

namespace proofmass::calibrate {

/// Initial values of the descent: the best in |f| − 1 of
///
///     the quadric uᵀA u + 2 dᵀu + c = 0 with the least Σ (…)² for coefficients of unit length,
///     the same with A diagonal, the sphere, and the box of the readings,
///
/// except those whose A is not positive definite; one always exists. With bias −A⁻¹d and A = MᵀM up
/// to a factor, M = T diag(1/scale) upper triangular is Cholesky's factor. `with_misalignment`
/// admits the first. Source: Q. Li, J. G. Griffiths, Least squares ellipsoid specific fitting,
/// Geometric Modeling and Processing (2004), the quadric. Cost: O(poses).
[[nodiscard]] Parameters ellipsoid_start(View<NormalisedPose> poses, bool with_misalignment);

}  // namespace proofmass::calibrate
