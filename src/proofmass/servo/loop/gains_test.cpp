#include "proofmass/servo/loop/gains.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

#include "proofmass/servo/loop/linear_motor.hpp"

namespace proofmass::servo {
namespace {

const MotorModel drive{.resistance_ohm = 13.0,
                       .inductance_h = 0.06,
                       .torque_constant_nmpa = 22.6,
                       .inertia_kgm2 = 0.6,
                       .viscous_nmspr = 0.8};

// SciPy 1.10: F, G by scipy.linalg.expm, K by scipy.linalg.solve_discrete_are, of the same
// matrices.
TEST(ServoGains, AreThoseOfAnotherSolverOfTheRiccatiEquation) {
  const Gains found = design(
      drive, 0.005, 1, {.angle_rad = 0.03, .speed_radps = 1.0, .integral = 0.02, .voltage_v = 6.0});
  const std::array<double, 5> expected{233.478716, 3.78552615, 0.672940454, 0.0565850806,
                                       291.439685};
  ASSERT_EQ(found.K.size(), 5);
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found.K(static_cast<Eigen::Index>(k)), expected[k], 1e-5 * std::abs(expected[k]))
        << k;
}

// The end of a step response without friction: u K/(K² + R b) and the torque's share.
TEST(ServoGains, TheSampledMotorEndsAtItsSteadySpeed) {
  const SampledMotor step = sampled(drive, drive.viscous_nmspr, 0.0, 0.005);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int k = 0; k < 1000; ++k) x = step.F * x + step.from_voltage * 24.0;
  const double K = drive.torque_constant_nmpa;
  EXPECT_NEAR(x(1), 24.0 * K / (K * K + drive.resistance_ohm * drive.viscous_nmspr), 1e-6);
  EXPECT_NEAR(x(2), drive.viscous_nmspr * x(1) / K, 1e-6);
}

TEST(ServoGains, TheLoopIsStableWithEachDelay) {
  for (const int delay : {1, 2, 5, 10}) {
    const Gains gains =
        design(drive, 0.005, delay,
               {.angle_rad = 0.03, .speed_radps = 1.0, .integral = 0.02, .voltage_v = 6.0});
    const SampledMotor step = sampled(drive, drive.viscous_nmspr, 0.0, 0.005);
    // Simulated from an angle error: it vanishes.
    Eigen::Vector3d x(0.5, 0.0, 0.0);
    std::vector<double> under_way(static_cast<std::size_t>(delay), 0.0);
    double integral = 0.0;
    for (int k = 0; k < 4000; ++k) {
      double v = -gains.K.head(3).dot(x) - gains.K(3 + delay) * integral;
      for (int j = 0; j < delay; ++j) v -= gains.K(3 + j) * under_way[static_cast<std::size_t>(j)];
      integral += 0.005 * x(0);
      x = (step.F * x + step.from_voltage * under_way.front()).eval();
      under_way.erase(under_way.begin());
      under_way.push_back(v);
    }
    EXPECT_LT(x.cwiseAbs().maxCoeff(), 1e-6) << delay;
  }
}

}  // namespace
}  // namespace proofmass::servo
