#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/estimate/attitude.hpp"

// A body that is at rest, moves and rotates, and is at rest again, as measured by two sensors.
namespace proofmass::estimate::attitude_test {

struct Body {
  double rate_hz = 100.0;
  double rest_s = 2.0;  ///< before, between and after the moves
  double move_s = 3.0;
  int moves = 2;
  Mat<3> start = {0.2, -0.3, 0.0};     ///< rotation vector of the initial R_world_sensor
  Mat<3> turn_rad = {0.5, -0.4, 0.8};  ///< of each move, about the body's axes
  Mat<3> shift_m = {0.4, -0.2, 0.3};   ///< of each move, in world axes
};

struct Truth {
  std::vector<Mat<3, 3>> R;
  std::vector<Mat<3>> v, p, accel;
};

struct Scene {
  InertialSeries series;
  Truth truth;
  std::vector<signal::Rest> rests;
};

struct SensorErrors {
  Mat<3> rate_bias = Mat<3>::Zero(), accel_bias = Mat<3>::Zero();
  double rate_noise = 0.0, accel_noise = 0.0;  ///< two-sided densities
  std::uint64_t seed = 1;
};

/// Completed fraction of a move at s in [0, 1], with its first two derivatives with respect to s.
inline Mat<3> minimum_jerk(double s) {
  const double s2 = s * s, s3 = s2 * s;
  return {s3 * (10.0 - 15.0 * s + 6.0 * s2), s2 * (30.0 - 60.0 * s + 30.0 * s2),
          s * (60.0 - 180.0 * s + 120.0 * s2)};
}

inline Scene scene(const Body& body, const SensorErrors& errors) {
  constexpr double g = standard_gravity_mps2;
  constexpr int fine = 20;
  const double dt = 1.0 / body.rate_hz, h = dt / fine;
  const double period = body.rest_s + body.move_s;
  const auto phase = [&](double t) { return std::fmod(t, period) - body.rest_s; };
  const auto rate_at = [&](double t) {
    const double s = phase(t) / body.move_s;
    return s > 0.0 ? Mat<3>(body.turn_rad * (minimum_jerk(s).y() / body.move_s))
                   : Mat<3>(Mat<3>::Zero());
  };
  const auto size = static_cast<std::size_t>((period * body.moves + body.rest_s) * body.rate_hz);
  Random rate_noise(errors.seed, "rate"), accel_noise(errors.seed, "accel");
  Scene out;
  Mat<3, 3> R = rotation_by(body.start);
  for (std::size_t k = 0; k < size; ++k) {
    const double t = static_cast<double>(k) * dt;
    if (k > 0)
      for (int i = 0; i < fine; ++i)
        R = (R * rotation_by(h * rate_at(t - dt + (i + 0.5) * h))).eval();
    const double s = std::max(0.0, phase(t) / body.move_s);
    const double done = std::floor(t / period);
    const Mat<3> share = minimum_jerk(s);
    const Mat<3> accel = body.shift_m * (share.z() / (body.move_s * body.move_s));
    out.truth.R.push_back(R);
    out.truth.p.push_back(body.shift_m * (done + share.x()));
    out.truth.v.push_back(body.shift_m * (share.y() / body.move_s));
    out.truth.accel.push_back(accel);
    const Mat<3> rate = rate_at(t) + errors.rate_bias;
    const Mat<3> force = R.transpose() * (accel + Mat<3>(0.0, 0.0, g)) + errors.accel_bias;
    out.series.time_s.push_back(t);
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      out.series.rate_radps[axis].push_back(rate(i) + errors.rate_noise / std::sqrt(dt) *
                                                          rate_noise.normal());
      out.series.accel_mps2[axis].push_back(force(i) + errors.accel_noise / std::sqrt(dt) *
                                                           accel_noise.normal());
    }
  }
  const auto samples = [&](double t) { return static_cast<std::size_t>(t * body.rate_hz + 0.5); };
  for (int i = 0; i <= body.moves; ++i)
    out.rests.push_back({samples(i * period), samples(i * period + body.rest_s) - 1});
  return out;
}

/// Rotation vector of the estimate's error, in world axes, minus the initial heading, which is 0 by
/// definition.
inline Mat<3> attitude_error(const Scene& scene, const Attitude& attitude, std::size_t k) {
  const Mat<3, 3> E0 = scene.truth.R.front() * rotation_of(attitude.quaternion.front()).transpose();
  const double heading = std::atan2(E0(1, 0) - E0(0, 1), E0(0, 0) + E0(1, 1));
  const Mat<3, 3> align = rotation_by({0.0, 0.0, heading});
  return rotation_vector(align.transpose() * scene.truth.R[k] *
                         rotation_of(attitude.quaternion[k]).transpose());
}

}  // namespace proofmass::estimate::attitude_test
