#include "proofmass/servo/motor_model.hpp"

#include <cmath>

namespace proofmass::servo {

double MotorModel::dry_friction_nm(double speed_radps) const {
  constexpr double through_zero_radps = 0.02;
  const double ratio = speed_radps / stribeck_speed_radps;
  return (coulomb_nm + (breakaway_nm - coulomb_nm) * std::exp(-ratio * ratio)) *
         std::tanh(speed_radps / through_zero_radps);
}

Result<MotorModel> model_of(const estimate::MotorSolution& found, double inductance_h) {
  const auto value = [&](const char* name, double otherwise) {
    const estimate::MotorParameter* one = found.find(name);
    return one != nullptr && one->value ? one->value->value : otherwise;
  };
  MotorModel model{.resistance_ohm = value("resistance", 0.0),
                   .inductance_h = inductance_h,
                   .torque_constant_nmpa = value("torque_constant", 0.0),
                   .inertia_kgm2 = value("inertia", 0.0),
                   .viscous_nmspr = value("viscous_friction", 0.0),
                   .coulomb_nm = value("coulomb_friction", 0.0),
                   .stribeck_speed_radps = value("stribeck_speed", 0.1),
                   .backlash_rad = value("backlash", 0.0)};
  model.breakaway_nm = value("breakaway_friction", model.coulomb_nm);
  if (!(model.resistance_ohm > 0.0) || !(model.torque_constant_nmpa > 0.0) ||
      !(model.inertia_kgm2 > 0.0))
    return Error{Errc::not_observable,
                 "the recording does not determine resistance, torque constant and inertia, "
                 "without which there is no controller"};
  return model;
}

}  // namespace proofmass::servo
