#include "proofmass/servo/loop/linear_motor.hpp"

#include <cmath>

namespace proofmass::servo {

SampledMotor sampled(const MotorModel& model,
                     double damping_nmspr,
                     double torque_noise,
                     double step_s) {
  using Eigen::Matrix3d;
  using Eigen::Vector3d;
  // A short step by the series, then doubled: F(2h) = F², G(2h) = F G + G, Q(2h) = F Q Fᵀ + Q.
  constexpr int doublings = 12;
  const double h = std::ldexp(step_s, -doublings), J = model.inertia_kgm2, L = model.inductance_h;
  Matrix3d A = Matrix3d::Zero();
  A(0, 1) = 1.0;
  A(1, 1) = -damping_nmspr / J;
  A(1, 2) = model.torque_constant_nmpa / J;
  A(2, 1) = -model.torque_constant_nmpa / L;
  A(2, 2) = -model.resistance_ohm / L;
  const Matrix3d integral = h * Matrix3d::Identity() + 0.5 * h * h * A;
  Matrix3d density = Matrix3d::Zero();
  density(1, 1) = std::pow(torque_noise / J, 2);
  SampledMotor out{.F = Matrix3d::Identity() + h * A + 0.5 * h * h * A * A,
                   .Q = h * density,
                   .from_voltage = integral * Vector3d(0.0, 0.0, 1.0 / L),
                   .from_torque = integral * Vector3d(0.0, 1.0 / J, 0.0)};
  for (int k = 0; k < doublings; ++k) {
    out.Q = (out.F * out.Q * out.F.transpose() + out.Q).eval();
    out.from_voltage = (out.F * out.from_voltage + out.from_voltage).eval();
    out.from_torque = (out.F * out.from_torque + out.from_torque).eval();
    out.F = (out.F * out.F).eval();
  }
  return out;
}

}  // namespace proofmass::servo
