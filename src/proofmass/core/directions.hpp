#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace proofmass {

/// `count` unit vectors spread evenly over the sphere, from z to −z along a spiral, each rotated
/// from the previous one by the golden angle:
///
///     z_k = 1 − (2k + 1)/n,   φ_k = k π (3 − √5).
///
/// Source: Á. González, Measurement of areas on a sphere using Fibonacci and latitude–longitude
/// lattices, Mathematical Geosciences 42 (2010) 49, section 3.1.
[[nodiscard]] std::vector<Eigen::Vector3d> spread_directions(std::size_t count);

}  // namespace proofmass
