#pragma once

#include <Eigen/Core>

#include "proofmass/servo/motor_model.hpp"

namespace proofmass::servo {

/// Weights of the linear quadratic regulator: the sizes that count as equal.
struct Weights {
  double angle_rad = 0.0;  ///< 0: a speed controller, without feedback of the angle
  double speed_radps = 1.0;
  double integral = 1.0;  ///< of the integrated error, rad s or rad
  double voltage_v = 10.0;
};

/// Voltage = −K (angle error, speed error, current, voltages under way, integrated error).
struct Gains {
  Eigen::RowVectorXd K;
  int delay_samples = 1;
};

/// The gains that minimise the weighted squares for the linear model of the drive, sampled, with
/// its delay as further states.
/// Source: K. J. Åström, B. Wittenmark, Computer-Controlled Systems (1997), section 11.3.
[[nodiscard]] Gains design(const MotorModel& model,
                           double step_s,
                           int delay_samples,
                           const Weights& weights);

}  // namespace proofmass::servo
