#pragma once

#include "proofmass/estimate/motor.hpp"

namespace proofmass::servo {

/// A drive as a controller knows it, in coordinates of the load's shaft.
struct MotorModel {
  double resistance_ohm = 0.0, inductance_h = 0.0;
  double torque_constant_nmpa = 0.0;
  double inertia_kgm2 = 0.0;
  double viscous_nmspr = 0.0, coulomb_nm = 0.0, breakaway_nm = 0.0;
  double stribeck_speed_radps = 1.0;
  double backlash_rad = 0.0;

  /// Dry friction at a speed, smooth through zero over ± 0.02 rad/s.
  [[nodiscard]] double dry_friction_nm(double speed_radps) const;
};

/// The model that `motor` identifies; an effect whose figure it does not determine is left out. The
/// inductance, which it does not report, is given. Errors: not_observable (without resistance,
/// torque constant or inertia there is no model).
[[nodiscard]] Result<MotorModel> model_of(const estimate::MotorSolution& found,
                                          double inductance_h);

}  // namespace proofmass::servo
