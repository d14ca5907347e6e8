#include "proofmass/calibrate/gyroscope/motion.hpp"

#include <Eigen/Geometry>
#include <numeric>

#include "proofmass/core/so3.hpp"

namespace proofmass::calibrate {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double MotionSamples::duration_s() const {
  return std::accumulate(step_s.begin(), step_s.end(), 0.0);
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
    const Vector3d shifted = motion.stamp_std_s / dt * (middle * (w1 - w0));
    out.noise += shifted * shifted.transpose();
    out.turned_rad += phi.norm();
    P = P * rotation_by(phi).transpose();
  }
  out.R = P.transpose();
  return out;
}

}  // namespace proofmass::calibrate
