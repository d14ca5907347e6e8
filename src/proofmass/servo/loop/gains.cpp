#include "proofmass/servo/loop/gains.hpp"

#include <cmath>

namespace proofmass::servo {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Sampled {
  Matrix3d F;
  Vector3d G;
};

// Angle, speed and current over a step with a constant voltage: many short ones.
Sampled sampled(const estimate::DriveModel& m, double step_s) {
  constexpr int doublings = 12;
  const double h = std::ldexp(step_s, -doublings);
  Matrix3d A = Matrix3d::Zero();
  A(0, 1) = 1.0;
  A(1, 1) = -m.viscous_nmspr / m.inertia_kgm2;
  A(1, 2) = m.torque_constant_nmpa / m.inertia_kgm2;
  A(2, 1) = -m.torque_constant_nmpa / m.inductance_h;
  A(2, 2) = -m.resistance_ohm / m.inductance_h;
  const Vector3d B(0.0, 0.0, 1.0 / m.inductance_h);
  const Matrix3d first = Matrix3d::Identity() + h * A + 0.5 * h * h * A * A;
  Sampled out{.F = first, .G = (h * Matrix3d::Identity() + 0.5 * h * h * A) * B};
  for (int k = 0; k < doublings; ++k) {
    out.G = (out.F * out.G + out.G).eval();
    out.F = (out.F * out.F).eval();
  }
  return out;
}

}  // namespace

Gains design(const estimate::DriveModel& model,
             double step_s,
             int delay_samples,
             const Weights& weights) {
  const bool of_angle = weights.angle_rad > 0.0;
  const Sampled drive = sampled(model, step_s);
  const Index d = delay_samples, n = 3 + d + 1;
  MatrixXd F = MatrixXd::Zero(n, n), Q = MatrixXd::Zero(n, n);
  VectorXd G = VectorXd::Zero(n);
  F.topLeftCorner(3, 3) = drive.F;
  if (!of_angle) F(0, 0) = F(0, 1) = F(0, 2) = 0.0;
  // The oldest voltage under way acts now; the newest enters the queue.
  if (d > 0)
    F.block(0, 3, 3, 1) = drive.G;
  else
    G.head(3) = drive.G;
  if (!of_angle) F(0, 3) = 0.0;
  for (Index k = 0; k + 1 < d; ++k) F(3 + k, 4 + k) = 1.0;
  if (d > 0) G(3 + d - 1) = 1.0;
  F(n - 1, n - 1) = 1.0;
  F(n - 1, of_angle ? 0 : 1) = step_s;
  if (of_angle) Q(0, 0) = 1.0 / std::pow(weights.angle_rad, 2);
  Q(1, 1) = 1.0 / std::pow(weights.speed_radps, 2);
  Q(n - 1, n - 1) = 1.0 / std::pow(weights.integral, 2);
  const double R = 1.0 / std::pow(weights.voltage_v, 2);
  MatrixXd P = Q;
  Gains out{.K = Eigen::RowVectorXd::Zero(n), .delay_samples = delay_samples};
  constexpr int iterations = 20000;
  for (int k = 0; k < iterations; ++k) {
    const Eigen::RowVectorXd GP = G.transpose() * P;
    const Eigen::RowVectorXd K = GP * F / (R + GP * G);
    P = (Q + F.transpose() * P * (F - G * K)).eval();
    P = (0.5 * (P + P.transpose())).eval();
    const double change = (K - out.K).cwiseAbs().maxCoeff();
    out.K = K;
    if (change < 1e-10 * K.cwiseAbs().maxCoeff()) break;
  }
  return out;
}

}  // namespace proofmass::servo
