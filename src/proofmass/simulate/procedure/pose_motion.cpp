#include "proofmass/simulate/procedure/pose_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "proofmass/simulate/rig/profile.hpp"

namespace proofmass::simulate {
namespace {

/// Vertical acceleration of something lifted within the first 0.4 of a move and set down within the
/// last 0.4.
double heave_mps2(double s, double move_s, double lift_m) {
  constexpr double part = 0.4;
  const double scale = lift_m / (part * part * move_s * move_s);
  if (s < part) return scale * minimum_jerk(s / part).accel;
  if (s > 1.0 - part) return -scale * minimum_jerk((s - 1.0 + part) / part).accel;
  return 0.0;
}

/// The shortest rotation from one direction to the other, completed to the fraction s.
Eigen::Vector3d partly_turned(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double s) {
  const Eigen::Vector3d across = from.cross(to);
  const double sine = across.norm();
  const Eigen::Vector3d axis = sine > 1e-9 ? Eigen::Vector3d(across / sine) : from.unitOrthogonal();
  return Eigen::AngleAxisd(s * std::atan2(sine, from.dot(to)), axis) * from;
}

}  // namespace

TripleNoise::TripleNoise(double rms,
                         double bandwidth_hz,
                         const ProcedureOptions& options,
                         const char* name)
    : axes_{BandLimitedNoise(rms, bandwidth_hz, Random(session_seed(options), name, 0)),
            BandLimitedNoise(rms, bandwidth_hz, Random(session_seed(options), name, 1)),
            BandLimitedNoise(rms, bandwidth_hz, Random(session_seed(options), name, 2))} {}

Eigen::Vector3d TripleNoise::at(double t_s) const {
  return {axes_[0].at(t_s), axes_[1].at(t_s), axes_[2].at(t_s)};
}

PoseMotion::PoseMotion(const ProcedureOptions& options,
                       std::vector<PlannedPose> plan,
                       bool with_rates)
    : plan_(std::move(plan)),
      hand_(options.hand),
      radius_m_(options.table.radius_m),
      axis_tilt_rad_(options.table.axis_tilt_rad),
      with_rates_(with_rates),
      sway_(hand_.sway_rms_mps2, 3.0, options, "sway of the hand"),
      tremor_(hand_.tremor_rms_mps2 * std::numbers::sqrt2, 2.0, options, "tremor of the hand"),
      wobble_(hand_.wobble_rms_rad, 2.0, options, "wobble of the hand"),
      motor_(options.table.vibration_mps2, 20.0, options, "motor of the table") {
  draw_arrivals(options);
}

void PoseMotion::draw_arrivals(const ProcedureOptions& options) {
  Random random(session_seed(options), "knocks");
  const auto vector = [&] {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return Eigen::Vector3d(x, y, z);
  };
  arrivals_.resize(plan_.size());
  for (std::size_t k = 1; k < plan_.size(); ++k) {
    Arrival& arrival = arrivals_[k];
    const double from_s = plan_[k - 1].end_s, to_s = plan_[k].stand_s;
    const auto shock = [&](double middle_share, double strength) {
      const double duration_s = std::min(0.022 + 0.01 * random.uniform(), 0.2 * (to_s - from_s));
      const double start_s = from_s + (to_s - from_s - duration_s) * middle_share;
      const double size = hand_.bump_mps2 * strength * (1.0 + 0.5 * random.uniform());
      arrival.shocks.push_back({start_s, duration_s, size * (plan_[k].up + 0.5 * vector())});
    };
    const double chance = random.uniform(), where = 0.5 + 0.3 * random.uniform();
    if (!plan_[k].turned_here) {
      shock(0.0, 0.2);
      if (chance > 1.0 / 3.0) shock(where, 0.5);
      shock(1.0, 1.0);
    }
    arrival.ringing_mps2 = options.timing.settle_mps2 * vector();
    arrival.ringing_radps =
        rad_per_turn * options.timing.settle_hz * (1.0 + 0.2 * random.uniform());
  }
}

std::size_t PoseMotion::last_stood(double t_s) const {
  const auto after = std::ranges::upper_bound(plan_, t_s, {}, &PlannedPose::stand_s);
  return after == plan_.begin() ? 0 : static_cast<std::size_t>(after - plan_.begin()) - 1;
}

SensorMotion PoseMotion::at(double t_s) const {
  const std::size_t k = last_stood(t_s);
  if (t_s >= plan_[k].end_s && k + 1 < plan_.size())
    return plan_[k + 1].turned_here ? on_table(k + 1, t_s) : in_hand(k + 1, t_s);
  return {.force_mps2 = plan_[k].force_mps2 * plan_[k].up + ringing(k, t_s)};
}

std::size_t PoseMotion::rest_at(double t_s) const {
  const std::size_t k = last_stood(t_s);
  return t_s >= plan_[k].rest_s && t_s < plan_[k].end_s ? k + 1 : 0;
}

const PlannedPose& PoseMotion::aimed_at(double t_s) const {
  const std::size_t k = last_stood(t_s);
  return plan_[t_s >= plan_[k].end_s && k + 1 < plan_.size() ? k + 1 : k];
}

double PoseMotion::moving_rad(double PlannedPose::* angle, double t_s) const {
  const std::size_t k = last_stood(t_s);
  const double here = plan_[k].*angle;
  if (t_s < plan_[k].end_s || k + 1 == plan_.size()) return here;
  const PlannedPose& next = plan_[k + 1];
  const double s = (t_s - plan_[k].end_s) / (next.stand_s - plan_[k].end_s);
  return here + (next.*angle - here) * minimum_jerk(s).place;
}

// Decays to exactly zero within the settling.
Eigen::Vector3d PoseMotion::ringing(std::size_t pose, double t_s) const {
  const PlannedPose& p = plan_[pose];
  if (t_s >= p.rest_s) return Eigen::Vector3d::Zero();
  const double passed_s = t_s - p.stand_s, share = passed_s / (p.rest_s - p.stand_s);
  const double size = std::exp(-4.0 * share) * (1.0 - share) * (1.0 - share);
  return size * std::sin(arrivals_[pose].ringing_radps * passed_s) * arrivals_[pose].ringing_mps2;
}

SensorMotion PoseMotion::on_table(std::size_t next, double t_s) const {
  const PlannedPose &from = plan_[next - 1], &to = plan_[next];
  const double move_s = to.stand_s - from.end_s, s = (t_s - from.end_s) / move_s;
  const Way way = minimum_jerk(s);
  const double turn_rad = to.angle_rad - from.angle_rad;
  const double omega = turn_rad * way.velocity / move_s;
  const double alpha = turn_rad * way.accel / (move_s * move_s);
  const Eigen::Vector3d force =
      to.force_mps2 * up_on_table(from.angle_rad + turn_rad * way.place, axis_tilt_rad_) +
      radius_m_ * Eigen::Vector3d(-omega * omega, alpha, 0.0) + swell(s) * motor_.at(t_s);
  return {.force_mps2 = to.R_sensor_table * force,
          .omega_radps = to.R_sensor_table * Eigen::Vector3d(0.0, 0.0, omega),
          .omega_dot_radps2 = to.R_sensor_table * Eigen::Vector3d(0.0, 0.0, alpha)};
}

Eigen::Vector3d PoseMotion::up_in_hand(std::size_t next, double t_s) const {
  const PlannedPose &from = plan_[next - 1], &to = plan_[next];
  const double s = std::clamp((t_s - from.end_s) / (to.stand_s - from.end_s), 0.0, 1.0);
  const Eigen::Vector3d straight = partly_turned(from.up, to.up, minimum_jerk(s).place);
  return (straight + swell(s) * wobble_.at(t_s)).normalized();
}

// Without rotation about the vertical: u' = u × ω, hence ω = u' × u.
Eigen::Vector3d PoseMotion::omega_in_hand(std::size_t next, double t_s) const {
  constexpr double h = 1e-3;
  const Eigen::Vector3d slope = (up_in_hand(next, t_s + h) - up_in_hand(next, t_s - h)) / (2.0 * h);
  return slope.cross(up_in_hand(next, t_s));
}

SensorMotion PoseMotion::in_hand(std::size_t next, double t_s) const {
  const PlannedPose &from = plan_[next - 1], &to = plan_[next];
  const double move_s = to.stand_s - from.end_s, s = (t_s - from.end_s) / move_s;
  const Eigen::Vector3d up = up_in_hand(next, t_s);
  const double weight_mps2 =
      from.force_mps2 + (to.force_mps2 - from.force_mps2) * minimum_jerk(s).place;
  const double carrier = std::cos(rad_per_turn * 10.0 * t_s);
  SensorMotion motion;
  motion.force_mps2 = (weight_mps2 + heave_mps2(s, move_s, hand_.lift_m)) * up +
                      swell(s) * (sway_.at(t_s) + carrier * tremor_.at(t_s));
  for (const Shock& shock : arrivals_[next].shocks) {
    const double part = (t_s - shock.start_s) / shock.duration_s;
    if (part > 0.0 && part < 1.0)
      motion.force_mps2 += std::sin(std::numbers::pi * part) * shock.peak_mps2;
  }
  if (with_rates_) {
    constexpr double h = 1e-3;
    motion.omega_radps = omega_in_hand(next, t_s);
    motion.omega_dot_radps2 =
        (omega_in_hand(next, t_s + h) - omega_in_hand(next, t_s - h)) / (2.0 * h);
  }
  return motion;
}

}  // namespace proofmass::simulate
