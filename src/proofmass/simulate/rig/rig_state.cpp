#include "proofmass/simulate/rig/rig_state.hpp"

#include <cmath>
#include <numbers>

#include "proofmass/core/random.hpp"

namespace proofmass::simulate {

Eigen::Vector3d Instant::force_mps2(const Eigen::Vector3d& p) const {
  return still_mps2 - wheel.speed_radps * wheel.speed_radps * p +
         wheel.accel_radps2 * Eigen::Vector3d(-p.y(), p.x(), 0.0);
}

RigState::RigState(const RigOptions& o)
    : motion_(o.wheel.start_angle_rad, o.wheel.profile, o.wheel.ripple, o.seed),
      gravity_mps2_(o.gravity_mps2),
      tilt_rad_(o.wheel.axle_tilt_rad),
      rolling_radius_m_(o.wheel.rolling_radius_m),
      shake_horizontal_(o.wheel.shake_horizontal_rms_mps2,
                        o.wheel.shake_bandwidth_hz,
                        Random(o.seed, "horizontal shake")),
      shake_vertical_(o.wheel.shake_vertical_rms_mps2,
                      o.wheel.shake_bandwidth_hz,
                      Random(o.seed, "vertical shake")),
      supply_(o.supply),
      supply_phase_rad_(Random(o.seed, "supply ripple").phase()) {}

const Instant& RigState::at(double t_s) {
  if (now_.t_s == t_s) return now_;
  const WheelState s = motion_.at(t_s);
  const double sine = std::sin(s.angle_rad), cosine = std::cos(s.angle_rad);
  const double level = std::cos(tilt_rad_);
  const double up = gravity_mps2_ + shake_vertical_.at(t_s);
  const double along = shake_horizontal_.at(t_s) - rolling_radius_m_ * s.accel_radps2;
  now_ = {t_s, s,
          up * Eigen::Vector3d(sine * level, cosine * level, std::sin(tilt_rad_)) +
              along * Eigen::Vector3d(cosine, -sine, 0.0),
          supply_v(t_s)};
  return now_;
}

double RigState::supply_v(double t_s) const {
  if (supply_.ripple_rms_v == 0.0) return supply_.nominal_v;
  return supply_.nominal_v +
         std::numbers::sqrt2 * supply_.ripple_rms_v *
             std::sin(rad_per_turn * supply_.ripple_hz * t_s + supply_phase_rad_);
}

}  // namespace proofmass::simulate
