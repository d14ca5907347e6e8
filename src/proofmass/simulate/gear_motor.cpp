#include "proofmass/simulate/gear_motor.hpp"

#include <algorithm>
#include <cmath>

namespace proofmass::simulate {
namespace {

double sign_of(double x) {
  return x < 0.0 ? -1.0 : 1.0;
}

// Speed after a step with dry friction, which stops a body but never drives it.
double with_friction(double speed, double torque_nm, double friction_nm, double inertia, double h) {
  if (speed == 0.0) {
    if (std::abs(torque_nm) <= friction_nm) return 0.0;
    return h * (torque_nm - sign_of(torque_nm) * friction_nm) / inertia;
  }
  const double next = speed + h * (torque_nm - sign_of(speed) * friction_nm) / inertia;
  return next * speed < 0.0 ? 0.0 : next;
}

}  // namespace

GearMotor::GearMotor(const GearMotorParameters& parameters) : p_(parameters) {
  meet(1);
  state_.load_rad = -0.5 * p_.backlash_rad;
}

void GearMotor::advance(double voltage_v, double duration_s) {
  constexpr double longest_s = 50e-6;
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / longest_s - 1e-9)));
  for (int k = 0; k < steps; ++k) step(voltage_v, duration_s / steps);
}

double GearMotor::motor_friction(double speed_radps) const {
  const double ratio = speed_radps / p_.stribeck_speed_radps;
  return p_.coulomb_nm + (p_.breakaway_nm - p_.coulomb_nm) * std::exp(-ratio * ratio);
}

double GearMotor::unbalance() const {
  return p_.unbalance_nm * std::cos(state_.load_rad + p_.unbalance_phase_rad);
}

void GearMotor::meet(int flank) {
  const double J = p_.motor_inertia_kgm2, Jl = p_.load_inertia_kgm2;
  const double common = (J * state_.motor_radps + Jl * state_.load_radps) / (J + Jl);
  state_.motor_radps = state_.load_radps = common;
  state_.contact = flank;
  state_.load_rad = state_.motor_rad - 0.5 * flank * p_.backlash_rad;
}

void GearMotor::step_together(double motor_nm, double h_s) {
  const double J = p_.motor_inertia_kgm2, Jl = p_.load_inertia_kgm2, w = state_.motor_radps;
  const double next = with_friction(w, motor_nm - p_.viscous_nmspr * w - unbalance(),
                                    motor_friction(w) + p_.load_coulomb_nm, J + Jl, h_s);
  const double accel = (next - w) / h_s;
  const double moving = next != 0.0 ? next : w;
  // At rest the load's own friction holds it, whatever the gear does.
  const double load_friction = moving == 0.0 ? 0.0 : sign_of(moving) * p_.load_coulomb_nm;
  const bool held = moving == 0.0 && std::abs(unbalance()) <= p_.load_coulomb_nm;
  const double gear_nm = held ? 0.0 : Jl * accel + load_friction + unbalance();
  if (state_.contact * gear_nm < 0.0) {
    state_.contact = 0;
    step_apart(motor_nm, h_s);
    return;
  }
  state_.motor_rad += 0.5 * h_s * (w + next);
  state_.motor_radps = state_.load_radps = next;
  state_.load_radps2 = accel;
  state_.load_rad = state_.motor_rad - 0.5 * state_.contact * p_.backlash_rad;
}

void GearMotor::step_apart(double motor_nm, double h_s) {
  const double w = state_.motor_radps, wl = state_.load_radps;
  const double next = with_friction(w, motor_nm - p_.viscous_nmspr * w, motor_friction(w),
                                    p_.motor_inertia_kgm2, h_s);
  const double load =
      with_friction(wl, -unbalance(), p_.load_coulomb_nm, p_.load_inertia_kgm2, h_s);
  state_.motor_rad += 0.5 * h_s * (w + next);
  state_.load_rad += 0.5 * h_s * (wl + load);
  state_.motor_radps = next;
  state_.load_radps = load;
  state_.load_radps2 = (load - wl) / h_s;
  const double apart = state_.motor_rad - state_.load_rad, half = 0.5 * p_.backlash_rad;
  if (apart >= half && next >= load) meet(1);
  if (apart <= -half && next <= load) meet(-1);
}

void GearMotor::step(double voltage_v, double h_s) {
  // The current with the speed as it is: exact for a short step.
  const double settled =
      (voltage_v - p_.torque_constant_nmpa * state_.motor_radps) / p_.resistance_ohm;
  const double kept =
      p_.inductance_h > 0.0 ? std::exp(-h_s * p_.resistance_ohm / p_.inductance_h) : 0.0;
  state_.current_a = settled + (state_.current_a - settled) * kept;
  const double motor_nm = p_.torque_constant_nmpa * state_.current_a;
  if (state_.contact != 0)
    step_together(motor_nm, h_s);
  else
    step_apart(motor_nm, h_s);
}

}  // namespace proofmass::simulate
