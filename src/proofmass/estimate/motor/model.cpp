#include "proofmass/estimate/motor/model.hpp"

#include <cmath>

namespace proofmass::estimate::motor {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector4d;

// exp(A h) and its integral by their series, for a small A h.
struct Exponential {
  Matrix4d value, integral;
};

Exponential exponential(const Matrix4d& A, double h) {
  Exponential out{Matrix4d::Identity(), Matrix4d::Identity() * h};
  Matrix4d term = Matrix4d::Identity();
  for (int n = 1; n <= 8; ++n) {
    term = term * A * (h / n);
    out.value += term;
    out.integral += term * (h / (n + 1));
  }
  return out;
}

// A short step by series, then doubled: F(2h) = F², Q(2h) = F Q Fᵀ + Q, G(2h) = F G + G.
Transition discretise(const Matrix4d& A,
                      const Matrix4d& density,
                      const Vector4d& voltage,
                      const Vector4d& torque,
                      double step_s) {
  constexpr double small = 0.25;
  const double size = A.cwiseAbs().rowwise().sum().maxCoeff() * step_s;
  const int doublings = size > small ? static_cast<int>(std::ceil(std::log2(size / small))) : 0;
  const double h = std::ldexp(step_s, -doublings);
  const Exponential whole = exponential(A, h), half = exponential(A, 0.5 * h);
  Transition out{.F = whole.value,
                 .Q = h / 6.0 *
                      (density + 4.0 * half.value * density * half.value.transpose() +
                       whole.value * density * whole.value.transpose()),
                 .from_voltage = whole.integral * voltage,
                 .from_torque = whole.integral * torque};
  for (int k = 0; k < doublings; ++k) {
    const Matrix4d F = out.F;
    out.Q = (F * out.Q * F.transpose() + out.Q).eval();
    out.from_voltage = (F * out.from_voltage + out.from_voltage).eval();
    out.from_torque = (F * out.from_torque + out.from_torque).eval();
    out.F = F * F;
  }
  return out;
}

}  // namespace

Transition moving(const Parameters& p, bool has_current, double step_s) {
  const double J = p.si(inertia);
  Matrix4d A = Matrix4d::Zero(), density = Matrix4d::Zero();
  A(0, 1) = 1.0;
  A(1, 1) = -p.value[viscous] / J;
  density(1, 1) = std::pow(p.si(torque_noise) / J, 2);
  Vector4d voltage(0.0, 1.0 / J, 0.0, 0.0);
  A(1, 3) = 1.0 / J;
  density(3, 3) = std::pow(p.si(voltage_noise), 2);
  if (has_current) {
    const double K = p.si(torque_constant), L = p.si(inductance);
    A(1, 2) = K / J;
    A(2, 1) = -K / L;
    A(2, 2) = -p.si(resistance) / L;
    A(1, 3) = 0.0;
    A(2, 3) = 1.0 / L;
    voltage = {0.0, 0.0, 1.0 / L, 0.0};
  }
  return discretise(A, density, voltage, {0.0, 1.0 / J, 0.0, 0.0}, step_s);
}

}  // namespace proofmass::estimate::motor
