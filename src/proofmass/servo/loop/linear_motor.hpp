#pragma once

#include <Eigen/Core>

#include "proofmass/servo/motor_model.hpp"

namespace proofmass::servo {

/// The drive without dry friction over one step with constant voltage and torque: angle, speed and
/// current.
struct SampledMotor {
  Eigen::Matrix3d F, Q;
  Eigen::Vector3d from_voltage, from_torque;
};

/// θ' = ω, J ω' = K i − damping · ω + torque, L i' = u − R i − K ω, with white noise of this
/// density (N m/√Hz) on the torque.
[[nodiscard]] SampledMotor sampled(const MotorModel& model,
                                   double damping_nmspr,
                                   double torque_noise,
                                   double step_s);

}  // namespace proofmass::servo
