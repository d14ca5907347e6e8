#include "proofmass/core/so3.hpp"

#include <cmath>
#include <cstddef>

namespace proofmass {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d A;
  A << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return A;
}

Vector3d cross(const Vector3d& a, const Vector3d& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

Matrix3d rotation_by(const Vector3d& angle_rad) {
  const double square = angle_rad.squaredNorm(), angle = std::sqrt(square);
  // sin φ/φ and (1 − cos φ)/φ² lose their digits near zero, where the series has them all.
  const bool small = angle < 1e-4;
  const double a = small ? 1.0 - square / 6.0 : std::sin(angle) / angle;
  const double half = std::sin(0.5 * angle);
  const double b = small ? 0.5 - square / 24.0 : 2.0 * half * half / square;
  const Matrix3d A = cross_matrix(angle_rad);
  return Matrix3d::Identity() + a * A + b * (A * A);
}

Vector3d rotation_vector(const Matrix3d& R) {
  const std::array<double, 4> q = quaternion_of(R, {1.0, 0.0, 0.0, 0.0});
  const Vector3d axis(q[1], q[2], q[3]);
  const double sine = axis.norm();
  if (sine < 1e-9) return 2.0 * axis;
  return axis * (2.0 * std::atan2(sine, q[0]) / sine);
}

std::array<double, 4> quaternion_of(const Matrix3d& R, const std::array<double, 4>& beside) {
  // Four times the squares of w, x, y, z; the largest is divided by.
  const std::array<double, 4> squares = {
      1.0 + R(0, 0) + R(1, 1) + R(2, 2), 1.0 + R(0, 0) - R(1, 1) - R(2, 2),
      1.0 - R(0, 0) + R(1, 1) - R(2, 2), 1.0 - R(0, 0) - R(1, 1) + R(2, 2)};
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (squares[i] > squares[largest]) largest = i;
  const double wx = R(2, 1) - R(1, 2), wy = R(0, 2) - R(2, 0), wz = R(1, 0) - R(0, 1);
  const double xy = R(0, 1) + R(1, 0), xz = R(0, 2) + R(2, 0), yz = R(1, 2) + R(2, 1);
  const std::array<std::array<double, 4>, 4> rows = {{{squares[0], wx, wy, wz},
                                                      {wx, squares[1], xy, xz},
                                                      {wy, xy, squares[2], yz},
                                                      {wz, xz, yz, squares[3]}}};
  std::array<double, 4> q = rows[largest];
  double norm = 0.0, side = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    norm += q[i] * q[i];
    side += q[i] * beside[i];
  }
  const double factor = (side < 0.0 ? -1.0 : 1.0) / std::sqrt(norm);
  for (double& x : q) x *= factor;
  return q;
}

Matrix3d rotation_of(const std::array<double, 4>& quaternion) {
  const auto [w, x, y, z] = quaternion;
  Matrix3d R;
  // clang-format off
  R << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z),       2.0 * (x * z + w * y),
       2.0 * (x * y + w * z),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
       2.0 * (x * z - w * y),       2.0 * (y * z + w * x),       1.0 - 2.0 * (x * x + y * y);
  // clang-format on
  return R;
}

Matrix3d orthonormal(const Matrix3d& R) {
  // One step of Newton's iteration for the polar factor doubles the digits of what is nearly one.
  return 0.5 * R * (3.0 * Matrix3d::Identity() - R.transpose() * R);
}

}  // namespace proofmass
