#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "proofmass/core/random.hpp"
#include "proofmass/core/so3.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/estimate/tilt.hpp"

namespace proofmass::estimate {

/// Output of a perfect accelerometer at rest.
inline Mat<3> force_at(double roll_rad, double pitch_rad, double gravity_mps2 = 9.80665) {
  return gravity_mps2 * Mat<3>(-std::sin(pitch_rad), std::cos(pitch_rad) * std::sin(roll_rad),
                               std::cos(pitch_rad) * std::cos(roll_rad));
}

/// A record at rest with white noise of one standard deviation on every axis.
inline TiltRecord still_record(const Mat<3>& force,
                               double noise_mps2,
                               std::size_t samples,
                               std::uint64_t seed) {
  Random random(seed, "still tilt");
  TiltRecord record;
  for (std::size_t k = 0; k < samples; ++k) {
    record.time_s.push_back(0.01 * static_cast<double>(k));
    for (std::size_t i = 0; i < 3; ++i)
      record.accel_mps2[i].push_back(force(static_cast<Eigen::Index>(i)) +
                                     noise_mps2 * random.normal());
  }
  return record;
}

/// A base that rotates and is shaken or swayed, and its true motion.
struct MovingBase {
  TiltRecord record;
  std::vector<Mat<3>> up;  ///< gravity's reaction in sensor axes, m/s²
  std::vector<double> roll_rad, pitch_rad;

  /// Appends an epoch; a rate only with a gyroscope.
  void add(double time_s, const Mat<3>& force, const Mat<3>* rate, const Mat<3>& g) {
    record.time_s.push_back(time_s);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      record.accel_mps2[i].push_back(force(row));
      if (rate != nullptr) record.rate_radps[i].push_back((*rate)(row));
    }
    up.push_back(g);
    roll_rad.push_back(std::atan2(g.y(), g.z()));
    pitch_rad.push_back(std::atan2(-g.x(), std::hypot(g.y(), g.z())));
  }
};

struct MovingOptions {
  std::size_t samples = 2000;
  double rate_hz = 100.0;
  double rest_s = 0.0;          ///< at either end
  double accel_std_mps2 = 0.5;  ///< in world axes, exponentially correlated
  double accel_time_s = 0.1;
  double sway_mps2 = 0.0;  ///< amplitude of a sine along one level direction
  double slowest_sway_hz = 0.02, fastest_sway_hz = 0.2;
  double turning = 1.0;  ///< factor on the rates
  double rate_noise_radps_rthz = 1e-3;
  double rate_bias_radps = 0.01, rate_scale = 0.0;
  double angular_accel_radps2_rthz = 0.0;  ///< > 0: white angular acceleration turns the base
  double reading_std_mps2 = 0.01;
  bool gyroscope = true;
};

inline MovingBase moving_base(const MovingOptions& o, std::uint64_t seed) {
  Random random(seed, "moving tilt");
  const auto normals = [&random](double std) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Mat<3>(std * x, std * y, std * z);
  };
  MovingBase out;
  const double h = 1.0 / o.rate_hz;
  Mat<3> g = force_at(0.3 * random.uniform(), 0.3 * random.uniform());
  const Mat<3> phase(random.phase(), random.phase(), random.phase());
  Mat<3> sway = normals(1.0);
  sway = o.sway_mps2 * Mat<3>(sway - g * (g.dot(sway) / g.squaredNorm())).normalized();
  const double sway_hz =
      o.slowest_sway_hz * std::pow(o.fastest_sway_hz / o.slowest_sway_hz, random.unit());
  const double sway_phase = random.phase();
  const Mat<3> bias = normals(o.rate_bias_radps);
  Mat<3, 3> error = Mat<3, 3>::Identity();
  for (int i = 0; i < 3; ++i) error.col(i) += normals(o.rate_scale);
  Mat<3> accel = normals(o.accel_std_mps2), rate = Mat<3>::Zero();
  const double phi = std::exp(-h / o.accel_time_s);
  const double end_s = h * static_cast<double>(o.samples) - o.rest_s;
  for (std::size_t k = 0; k < o.samples; ++k) {
    const double t = h * static_cast<double>(k);
    const bool rests = t < o.rest_s || t > end_s;
    const Mat<3> before = rate;
    if (rests)
      rate.setZero();
    else if (o.angular_accel_radps2_rthz > 0.0)
      rate += normals(o.angular_accel_radps2_rthz * std::sqrt(h));
    else
      rate = o.turning * Mat<3>(0.6 * std::sin(1.3 * t + phase.x()),
                                0.5 * std::sin(0.9 * t + phase.y()),
                                0.4 * std::sin(0.5 * t + phase.z()));
    const Mat<3, 3> R = rotation_by(Mat<3>(-0.5 * h * (rate + before)));
    if (k > 0) {
      g = R * g;
      sway = R * sway;
    }
    accel = phi * (R * accel) + normals(o.accel_std_mps2 * std::sqrt(1.0 - phi * phi));
    // A sway sets in within a second.
    const double strength = std::clamp(std::min(t - o.rest_s, end_s - t), 0.0, 1.0);
    const Mat<3> swayed = strength * std::sin(rad_per_turn * sway_hz * t + sway_phase) * sway;
    const Mat<3> f =
        g + (rests ? Mat<3>(Mat<3>::Zero()) : Mat<3>(accel + swayed)) + normals(o.reading_std_mps2);
    const Mat<3> w = error * rate + bias + normals(o.rate_noise_radps_rthz / std::sqrt(h));
    out.add(t, f, o.gyroscope ? &w : nullptr, g);
  }
  return out;
}

}  // namespace proofmass::estimate
