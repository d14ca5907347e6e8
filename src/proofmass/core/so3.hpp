#pragma once

#include <Eigen/Core>
#include <array>

// Rotations in space; depends on Eigen/Core only.
namespace proofmass {

/// [a]×, with [a]× b = a × b.
[[nodiscard]] Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a);

/// a × b.
[[nodiscard]] Eigen::Vector3d cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// exp([φ]×): the rotation by |φ| about φ, by Rodrigues' formula.
[[nodiscard]] Eigen::Matrix3d rotation_by(const Eigen::Vector3d& angle_rad);

/// φ with exp([φ]×) = R, |φ| ≤ π.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R);

/// The quaternion (w, x, y, z) of R with the sign nearest to `beside`, so that a series is
/// continuous. Source: S. W. Shepperd, J. Guidance and Control 1 (1978) 223.
[[nodiscard]] std::array<double, 4> quaternion_of(const Eigen::Matrix3d& R,
                                                  const std::array<double, 4>& beside);

/// The matrix of a quaternion (w, x, y, z) of unit length.
[[nodiscard]] Eigen::Matrix3d rotation_of(const std::array<double, 4>& quaternion);

/// The nearest rotation to a matrix with accumulated rounding errors.
[[nodiscard]] Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R);

}  // namespace proofmass
