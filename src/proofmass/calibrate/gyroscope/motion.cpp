#include "proofmass/calibrate/gyroscope/motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace proofmass::calibrate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double MotionSamples::duration_s() const {
  return std::accumulate(step_s.begin(), step_s.end(), 0.0);
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

Matrix3d rotation_by(const Vector3d& phi) {
  const double square = phi.squaredNorm(), angle = std::sqrt(square);
  const bool small = angle < 1e-4;
  const double first = small ? 1.0 - square / 6.0 : std::sin(angle) / angle;
  const double second = small ? 0.5 - square / 24.0 : (1.0 - std::cos(angle)) / square;
  const Matrix3d K = cross_matrix(phi);
  return Matrix3d::Identity() + first * K + second * K * K;
}

Vector3d rotation_vector(const Matrix3d& R) {
  const Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const double sine = 0.5 * twice_sine.norm(), cosine = 0.5 * (R.trace() - 1.0);
  const double angle = std::atan2(sine, cosine);
  if (sine > 1e-6) return 0.5 * angle / sine * twice_sine;
  if (cosine > 0.0) return 0.5 * twice_sine;
  // Half a turn: R = 2 n nᵀ − 1.
  Eigen::Index largest = 0;
  R.diagonal().maxCoeff(&largest);
  Vector3d n = 0.5 * (R.col(largest) + Vector3d::Unit(largest));
  return angle * n.normalized();
}

MotionRotation integrate(const MotionSamples& motion,
                         const Matrix3d& A,
                         const Matrix3d& G,
                         const Vector3d& noise_axes) {
  MotionRotation out;
  out.by_matrix.setZero();
  out.by_g.setZero();
  out.by_rate.setZero();
  out.noise.setZero();
  const Matrix3d noise_of_rate = A * noise_axes.asDiagonal() * A.transpose();
  const auto net = [&](std::size_t n) -> Vector3d {
    return motion.reading[n] - G * motion.force[n];
  };
  // From the end to the start, so that P rotates from the frame of a step to that of the end.
  Matrix3d P = Matrix3d::Identity();
  for (std::size_t n = motion.step_s.size(); n-- > 0;) {
    const double dt = motion.step_s[n];
    const Vector3d y0 = net(n), y1 = net(n + 1), y = 0.5 * (y0 + y1);
    const Vector3d w0 = A * y0, w1 = A * y1;
    const Vector3d phi = 0.5 * dt * (w0 + w1) + dt * dt / 12.0 * w0.cross(w1);
    const Matrix3d middle = dt * P * rotation_by(0.5 * phi).transpose();
    const Vector3d f = 0.5 * (motion.force[n] + motion.force[n + 1]);
    const Matrix3d of_reading = middle * A;
    for (Eigen::Index i = 0; i < 3; ++i) {
      out.by_matrix.middleCols<3>(3 * i) += middle.col(i) * y.transpose();
      out.by_g.middleCols<3>(3 * i) -= of_reading.col(i) * f.transpose();
    }
    out.by_rate += middle;
    out.noise += middle * noise_of_rate * middle.transpose() / dt;
    out.turned_rad += phi.norm();
    P = P * rotation_by(phi).transpose();
  }
  out.R = P.transpose();
  return out;
}

}  // namespace proofmass::calibrate
