#pragma once

#include <array>

#include "proofmass/estimate/gaussian.hpp"

// Rotations in space, with Eigen/Core alone.
namespace proofmass::estimate {

/// [a]×, with [a]× b = a × b.
[[nodiscard]] Mat<3, 3> cross_matrix(const Mat<3>& a);

/// a × b.
[[nodiscard]] Mat<3> cross(const Mat<3>& a, const Mat<3>& b);

/// exp([φ]×): the rotation by |φ| about φ, by Rodrigues' formula.
[[nodiscard]] Mat<3, 3> rotation_by(const Mat<3>& angle_rad);

/// φ with exp([φ]×) = R, |φ| ≤ π.
[[nodiscard]] Mat<3> rotation_vector(const Mat<3, 3>& R);

/// The (w, x, y, z) of R that lies on the side of `beside`, so that a series of them is continuous.
/// Source: S. W. Shepperd, J. Guidance and Control 1 (1978) 223.
[[nodiscard]] std::array<double, 4> quaternion_of(const Mat<3, 3>& R,
                                                  const std::array<double, 4>& beside);

/// The matrix of a quaternion (w, x, y, z) of unit length.
[[nodiscard]] Mat<3, 3> rotation_of(const std::array<double, 4>& quaternion);

/// The nearest rotation to a matrix that has drifted from one by rounding.
[[nodiscard]] Mat<3, 3> orthonormal(const Mat<3, 3>& R);

}  // namespace proofmass::estimate
