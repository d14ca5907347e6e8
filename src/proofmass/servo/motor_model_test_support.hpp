#pragma once

#include "proofmass/servo/motor_model.hpp"
#include "proofmass/simulate/gear_motor.hpp"

namespace proofmass::servo {

/// The controller's model of a simulated drive, with its true parameters.
inline MotorModel model_of(const simulate::GearMotorParameters& p) {
  return {.resistance_ohm = p.resistance_ohm,
          .inductance_h = p.inductance_h,
          .torque_constant_nmpa = p.torque_constant_nmpa,
          .inertia_kgm2 = p.motor_inertia_kgm2 + p.load_inertia_kgm2,
          .viscous_nmspr = p.viscous_nmspr,
          .coulomb_nm = p.coulomb_nm + p.load_coulomb_nm,
          .breakaway_nm = p.breakaway_nm + p.load_coulomb_nm,
          .stribeck_speed_radps = p.stribeck_speed_radps,
          .backlash_rad = p.backlash_rad};
}

}  // namespace proofmass::servo
