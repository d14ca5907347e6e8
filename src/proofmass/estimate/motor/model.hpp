#pragma once

#include <Eigen/Core>

#include "proofmass/estimate/motor/parameters.hpp"

namespace proofmass::estimate::motor {

/// One step of the states (motor angle, speed, current) with constant inputs.
struct Transition {
  Eigen::Matrix4d F, Q;
  Eigen::Vector4d from_voltage, from_torque;
};

/// Of the drive while it moves:
///
///     θ' = ω,   J ω' = K i − b ω + T,   L i' = u − R i − K ω,
///
/// with white noise on T and u; without a current, that of J' ω' = u − B ω + T.
[[nodiscard]] Transition moving(const Parameters& p, bool has_current, double step_s);

}  // namespace proofmass::estimate::motor
