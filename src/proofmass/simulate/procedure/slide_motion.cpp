#include "proofmass/simulate/procedure/slide_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/random.hpp"
#include "proofmass/simulate/rig/profile.hpp"

namespace proofmass::simulate {
namespace {

Eigen::Matrix3d turned_by(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

/// Uniform over all rotations. Source: K. Shoemake, Graphics Gems III (1992), page 124.
Eigen::Matrix3d any_rotation(Random& random) {
  const double u = random.unit(), a = random.phase(), b = random.phase();
  const double low = std::sqrt(1.0 - u), high = std::sqrt(u);
  return Eigen::Quaterniond(high * std::cos(b), low * std::sin(a), low * std::cos(a),
                            high * std::sin(b))
      .toRotationMatrix();
}

Eigen::Matrix3d mounting_of(const ProcedureOptions& options) {
  const ProcedureSlide& slide = options.slide;
  if (slide.any_mounting) {
    Random random(options.seed, "mounting on the slide");
    return any_rotation(random);
  }
  return (Eigen::AngleAxisd(slide.yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(slide.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(slide.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Position, velocity and acceleration along the line at the fraction s of a stroke.
Way way_of(SlideProfile profile, double s) {
  if (profile == SlideProfile::minimum_jerk) return minimum_jerk(s);
  constexpr double pi = std::numbers::pi;
  return {0.5 - 0.5 * std::cos(pi * s), 0.5 * pi * std::sin(pi * s),
          0.5 * pi * pi * std::cos(pi * s)};
}

}  // namespace

SlideMotion::SlideMotion(const ProcedureOptions& options)
    : slide_(options.slide),
      gravity_mps2_(options.gravity_mps2),
      direction_(std::cos(slide_.elevation_rad), 0.0, std::sin(slide_.elevation_rad)),
      mounting_(mounting_of(options)),
      turns_(slide_.turn_std_rad > 0.0 || slide_.wobble_rms_rad > 0.0),
      wobble_(slide_.wobble_rms_rad, 2.0, options, "wobble of the slide"),
      vibration_(
          slide_.vibration_mps2 * std::numbers::sqrt2, 2.0, options, "vibration of the slide") {
  plan(options);
}

void SlideMotion::plan(const ProcedureOptions& options) {
  const ProcedureTiming& timing = options.timing;
  Random dwell(session_seed(options), "dwell"), move(session_seed(options), "move"),
      length(session_seed(options), "length of strokes"), turn(session_seed(options), "turns");
  double now_s = 0.0, here_m = 0.0;
  const auto rest_for = [&](double seconds) {
    const double std = rests_.empty() ? 0.0 : slide_.turn_std_rad;
    const double x = turn.normal(), y = turn.normal(), z = turn.normal();
    turns_rad_.push_back(std * Eigen::Vector3d(x, y, z));
    const Eigen::Matrix3d R = mounting_ * turned_by(turns_rad_.back());
    rests_.push_back({.stand_s = now_s,
                      .rest_s = now_s,
                      .end_s = now_s + seconds,
                      .up = R.transpose() * Eigen::Vector3d::UnitZ(),
                      .force_mps2 = gravity_mps2_});
    now_s += seconds;
  };
  const auto stroke_to = [&](double to_m, std::size_t set) {
    const double duration_s = timing.move_s * (1.0 + timing.move_jitter * move.uniform());
    strokes_.push_back({strokes_.size() + 1, set, now_s, now_s + duration_s, here_m, to_m});
    here_m = to_m;
    now_s += duration_s;
  };
  rest_for(slide_.initial_rest_s);
  for (int set = 1; set <= slide_.strokes; ++set) {
    const auto number = static_cast<std::size_t>(set);
    const auto drawn_m = [&] {
      return slide_.length_m * (1.0 + slide_.length_jitter * length.uniform());
    };
    if (slide_.repetitions == 0) {
      const bool back = slide_.returning && set % 2 == 0;
      stroke_to(back ? 0.0 : here_m + drawn_m(), number);
    }
    for (int k = 0; k < slide_.repetitions; ++k) {
      if (k > 0) now_s += slide_.turn_pause_s;
      const double from_m = here_m;
      stroke_to(from_m + drawn_m(), number);
      now_s += slide_.turn_pause_s;
      stroke_to(from_m, number);
    }
    const bool last = set == slide_.strokes;
    rest_for(last ? slide_.final_rest_s
                  : timing.dwell_s * (1.0 + timing.dwell_jitter * dwell.uniform()));
  }
}

Eigen::Vector3d SlideMotion::line() const {
  return mounting_.transpose() * direction_;
}

std::size_t SlideMotion::last_rest(double t_s) const {
  const auto after = std::ranges::upper_bound(rests_, t_s, {}, &PlannedPose::stand_s);
  return after == rests_.begin() ? 0 : static_cast<std::size_t>(after - rests_.begin()) - 1;
}

/// Rotation vector from the mounting, after the rest with that index.
Eigen::Vector3d SlideMotion::turn_at(std::size_t rest, double t_s) const {
  if (rest + 1 == rests_.size() || t_s <= rests_[rest].end_s) return turns_rad_[rest];
  const double from_s = rests_[rest].end_s, to_s = rests_[rest + 1].stand_s;
  const double s = std::clamp((t_s - from_s) / (to_s - from_s), 0.0, 1.0);
  return turns_rad_[rest] + (turns_rad_[rest + 1] - turns_rad_[rest]) * minimum_jerk(s).place +
         swell(s) * wobble_.at(t_s);
}

void SlideMotion::move_along(double t_s, SlideState& state) const {
  const auto after = std::ranges::upper_bound(strokes_, t_s, {}, &TrueStroke::start_s);
  if (after == strokes_.begin()) return;
  const TrueStroke& last = *(after - 1);
  state.along_m = last.to_m;
  if (t_s >= last.end_s) return;
  const double duration_s = last.end_s - last.start_s, length_m = last.to_m - last.from_m;
  const Way way = way_of(slide_.profile, (t_s - last.start_s) / duration_s);
  state.stroke = last.number;
  state.along_m = last.from_m + length_m * way.place;
  state.velocity_mps = length_m * way.velocity / duration_s;
  state.accel_mps2 = length_m * way.accel / (duration_s * duration_s);
}

/// Rates from the rotations from shortly before to now and from now to shortly after.
Eigen::Matrix3d SlideMotion::rotate(std::size_t rest, double t_s, SlideState& state) const {
  const Eigen::Vector3d turn = turn_at(rest, t_s);
  const Eigen::Matrix3d R = turned_by(turn);
  state.turn_rad = turn.norm();
  if (state.rest > 0) return mounting_ * R;
  constexpr double h = 1e-3;
  const auto rate = [](const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
    const Eigen::AngleAxisd step(from.transpose() * to);
    return Eigen::Vector3d(step.angle() / h * step.axis());
  };
  const Eigen::Vector3d before = rate(turned_by(turn_at(rest, t_s - h)), R);
  const Eigen::Vector3d after = rate(R, turned_by(turn_at(rest, t_s + h)));
  state.motion.omega_radps = 0.5 * (before + after);
  state.motion.omega_dot_radps2 = (after - before) / h;
  return mounting_ * R;
}

SlideState SlideMotion::at(double t_s) const {
  const std::size_t rest = last_rest(t_s);
  SlideState state;
  if (t_s < rests_[rest].end_s || rest + 1 == rests_.size()) state.rest = rest + 1;
  move_along(t_s, state);
  const Eigen::Matrix3d R = turns_ ? rotate(rest, t_s, state) : mounting_;
  state.gravity_mps2 = gravity_mps2_ * R.row(2).transpose();
  state.motion.force_mps2 = state.gravity_mps2 + state.accel_mps2 * (R.transpose() * direction_);
  if (state.rest == 0 && slide_.vibration_mps2 > 0.0) {
    const double from_s = rests_[rest].end_s, to_s = rests_[rest + 1].stand_s;
    state.motion.force_mps2 += swell((t_s - from_s) / (to_s - from_s)) *
                               std::cos(rad_per_turn * 10.0 * t_s) * vibration_.at(t_s);
  }
  return state;
}

}  // namespace proofmass::simulate
