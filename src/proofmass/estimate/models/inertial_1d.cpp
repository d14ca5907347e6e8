#include "proofmass/estimate/models/inertial_1d.hpp"

#include "proofmass/core/contract.hpp"

namespace proofmass::estimate {
namespace {

/// Random walk of the speed during a cruise: 1 cm/s in one second.
constexpr double cruise_walk_m2ps3 = 1e-4;

// ∫∫ of white noise N², unknown accelerations included, and of a random walk q of the bias.
Mat<3, 3> motion_noise(const InertialEpoch& epoch, const InertialNoise& noise) {
  const double h = epoch.dt_s, h2 = h * h, h3 = h2 * h;
  const double N2 = noise.white_m2ps3 + noise.motion_lean_m2ps3 + epoch.unknown_accel_m2ps3;
  const double q = noise.motion_walk_m2ps5;
  Mat<3, 3> Q;
  Q(0, 0) = N2 * h3 / 3.0 + q * h3 * h2 / 20.0;
  Q(0, 1) = Q(1, 0) = N2 * h2 / 2.0 + q * h2 * h2 / 8.0;
  Q(1, 1) = N2 * h + q * h3 / 3.0;
  Q(0, 2) = Q(2, 0) = -q * h3 / 6.0;
  Q(1, 2) = Q(2, 1) = -q * h2 / 2.0;
  Q(2, 2) = q * h;
  return Q;
}

}  // namespace

Transition<3, 3> InertialAxis::transition(const Mat<3>& x, std::size_t k) const {
  const InertialEpoch& epoch = epochs[k];
  const double h = epoch.dt_s;
  Transition<3, 3> step;
  step.walk.setZero();
  if (epoch.resting && epoch.cruising) {
    step.F << 1.0, h, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0;
    step.mean = step.F * x;
    step.Q.setZero();
    step.Q(1, 1) = cruise_walk_m2ps3 * h;
    step.Q(2, 2) = noise.rest_walk_m2ps5 * h;
    return step;
  }
  if (epoch.resting) {
    step.F = Mat<3>(1.0, 0.0, 1.0).asDiagonal();
    step.mean = step.F * x;
    step.Q.setZero();
    step.Q(1, 1) = noise.rest_speed_std_mps * noise.rest_speed_std_mps;
    step.Q(2, 2) = noise.rest_walk_m2ps5 * h;
    return step;
  }
  step.F << 1.0, h, -0.5 * h * h, 0.0, 1.0, -h, 0.0, 0.0, 1.0;
  step.mean = step.F * x;
  step.mean(0) += epoch.position_step_m;
  step.mean(1) += epoch.velocity_step_mps;
  step.Q = motion_noise(epoch, noise);
  if (epoch.leaves_rest)
    step.Q += noise.motion_jump_m2ps4 * step.F.col(2) * step.F.col(2).transpose();
  if (epoch.arrives_at_rest) step.Q(2, 2) += noise.motion_jump_m2ps4;
  return step;
}

void InertialAxis::measure(const Mat<3>& x, std::size_t k, Readings<3, 3>& out) const {
  const InertialEpoch& epoch = epochs[k];
  out.count = 0;
  const auto read = [&](const Mat<3>& h, double value, double variance) {
    out.rows[static_cast<std::size_t>(out.count++)] = {value, h.dot(x), variance, h};
  };
  if (epoch.velocity_std_mps > 0.0)
    read(Mat<3>::Unit(inertial_axis::velocity_mps), 0.0,
         epoch.velocity_std_mps * epoch.velocity_std_mps);
  if (!std::isnan(epoch.level_mps2))
    read(Mat<3>::Unit(inertial_axis::bias_mps2), epoch.level_mps2, epoch.level_variance);
  if (!std::isnan(epoch.position_m)) {
    const double t = epoch.position_after_s;
    read({1.0, t, epoch.resting ? 0.0 : -0.5 * t * t}, epoch.position_m, epoch.position_variance);
  }
}

FilterState<3> inertial_start(const InertialStart& start) {
  FilterState<3> state;
  state.x.mean = Mat<3>(0.0, start.speed_mps, start.bias_mps2);
  state.x.cov.diagonal() << 0.0, start.speed_std_mps * start.speed_std_mps,
      start.bias_std_mps2 * start.bias_std_mps2;
  return state;
}

std::vector<InertialEpoch> join_epochs(View<InertialEpoch> epochs,
                                       const std::vector<std::size_t>& kept) {
  std::vector<InertialEpoch> joined;
  joined.reserve(kept.size());
  std::size_t next = 0;
  for (const std::size_t end : kept) {
    PM_EXPECTS(end >= next && end < epochs.size());
    InertialEpoch whole = epochs[end];
    double dt_s = 0.0, velocity = 0.0, position = 0.0, unknown = 0.0;
    for (; next <= end; ++next) {
      const InertialEpoch& part = epochs[next];
      position += velocity * part.dt_s + part.position_step_m;
      velocity += part.velocity_step_mps;
      dt_s += part.dt_s;
      whole.leaves_rest = whole.leaves_rest || part.leaves_rest;
      unknown += part.unknown_accel_m2ps3 * part.dt_s;
    }
    whole.dt_s = dt_s;
    whole.velocity_step_mps = velocity;
    whole.position_step_m = position;
    whole.unknown_accel_m2ps3 = dt_s > 0.0 ? unknown / dt_s : 0.0;
    joined.push_back(whole);
  }
  return joined;
}

}  // namespace proofmass::estimate
