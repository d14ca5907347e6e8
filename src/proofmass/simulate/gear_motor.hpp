#pragma once

namespace proofmass::simulate {

/// A DC motor with a permanent magnet, its gear and its load, in coordinates of the load's shaft.
/// The defaults are the thesis's gear motor (A.2.1): 90 V, 1.27 A and 31 rpm at full load with 114
/// W in and 93 W at the armature give R = 13 ohm and K = 22.6 V s/rad; inertia, friction and
/// backlash, which no data sheet states, are usual ones of a motor and gear of this size.
struct GearMotorParameters {
  double resistance_ohm = 13.0;
  double inductance_h = 0.06;
  double torque_constant_nmpa = 22.6;  ///< and back-EMF constant, V s/rad
  double motor_inertia_kgm2 = 0.6, load_inertia_kgm2 = 0.012;
  double viscous_nmspr = 0.8;          ///< N m per rad/s
  double coulomb_nm = 3.0;             ///< of motor and gear, well above speed zero
  double breakaway_nm = 4.0;           ///< at speed zero
  double stribeck_speed_radps = 0.08;  ///< over which friction falls from breakaway to Coulomb
  double load_coulomb_nm = 0.15;       ///< of the wheel's bearings
  double backlash_rad = 0.012;         ///< free play, full width
  double unbalance_nm = 0.0;           ///< largest torque of an unbalanced load
  double unbalance_phase_rad = 0.0;    ///< the load's torque is −unbalance · cos(angle + phase)
};

struct GearMotorState {
  double current_a = 0.0;
  double motor_rad = 0.0, motor_radps = 0.0;
  double load_rad = 0.0, load_radps = 0.0, load_radps2 = 0.0;
  int contact = 0;  ///< +1: the motor pushes the load forwards, −1: backwards, 0: in the gap
};

/// Two rigid bodies with a gap between them:
///
///     L i' = u − R i − K ω,
///     J ω' = K i − F(ω) − Tg,  F = (Tc + (Ts − Tc) exp(−(ω/ωs)²)) sgn ω + b ω,
///     Jl ωl' = Tg − load friction − unbalance.
///
/// A body at rest stays there while the torque on it is below breakaway. At the end of the gap the
/// speeds become equal and the momentum is kept; the flanks part where the gear would have to pull.
/// Integrated in steps of at most 50 µs.
class GearMotor {
 public:
  explicit GearMotor(const GearMotorParameters& parameters);

  /// Constant voltage for this time.
  void advance(double voltage_v, double duration_s);
  [[nodiscard]] const GearMotorState& state() const { return state_; }
  [[nodiscard]] const GearMotorParameters& parameters() const { return p_; }

 private:
  void step(double voltage_v, double h_s);
  void step_together(double motor_nm, double h_s);
  void step_apart(double motor_nm, double h_s);
  void meet(int flank);
  [[nodiscard]] double motor_friction(double speed_radps) const;
  [[nodiscard]] double unbalance() const;

  GearMotorParameters p_;
  GearMotorState state_;
};

}  // namespace proofmass::simulate
