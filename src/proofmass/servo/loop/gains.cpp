#include "proofmass/servo/loop/gains.hpp"

#include <cmath>

#include "proofmass/servo/loop/linear_motor.hpp"

namespace proofmass::servo {
Gains design(const MotorModel& model, double step_s, int delay_samples, const Weights& weights) {
  using Eigen::Index;
  using Eigen::MatrixXd;
  using Eigen::VectorXd;
  const bool of_angle = weights.angle_rad > 0.0;
  const SampledMotor drive = sampled(model, model.viscous_nmspr, 0.0, step_s);
  const Index d = delay_samples, n = 3 + d + 1;
  MatrixXd F = MatrixXd::Zero(n, n), Q = MatrixXd::Zero(n, n);
  VectorXd G = VectorXd::Zero(n);
  F.topLeftCorner(3, 3) = drive.F;
  if (!of_angle) F(0, 0) = F(0, 1) = F(0, 2) = 0.0;
  // The oldest voltage under way acts now; the newest enters the queue.
  if (d > 0)
    F.block(0, 3, 3, 1) = drive.from_voltage;
  else
    G.head(3) = drive.from_voltage;
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
