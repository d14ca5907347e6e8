#pragma once

#include <array>

#include "proofmass/estimate/filter/gaussian.hpp"

// Rotations in space; depends on Eigen/Core only.
namespace proofmass::estimate {

/// [a]×, with [a]× b = a × b.
[[nodiscard]] Mat<3, 3> cross_matrix(const Mat<3>& a);

/// a × b.
[[nodiscard]] Mat<3> cross(const Mat<3>& a, const Mat<3>& b);

/// exp([φ]×): the rotation by |φ| about φ, by Rodrigues' formula.
[[nodiscard]] Mat<3, 3> rotation_by(const Mat<3>& angle_rad);

/// φ with exp([φ]×) = R, |φ| ≤ π.
[[nodiscard]] Mat<3> rotation_vector(const Mat<3, 3>& R);

/// The quaternion (w, x, y, z) of R with the sign nearest to `beside`, so that a series is
/// continuous. Source: S. W. Shepperd, J. Guidance and Control 1 (1978) 223.
[[nodiscard]] std::array<double, 4> quaternion_of(const Mat<3, 3>& R,
                                                  const std::array<double, 4>& beside);

/// The matrix of a quaternion (w, x, y, z) of unit length.
[[nodiscard]] Mat<3, 3> rotation_of(const std::array<double, 4>& quaternion);

/// The nearest rotation to a matrix with accumulated rounding errors.
[[nodiscard]] Mat<3, 3> orthonormal(const Mat<3, 3>& R);

}  // namespace proofmass::estimate
