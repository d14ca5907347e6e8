#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
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

constexpr double none = std::numeric_limits<double>::quiet_NaN();
inline const TiltOptions exact{.gravity_mps2 = {9.80665, 1e-6}, .bias_std_mps2 = 0.0};
inline const TiltOptions uncalibrated{.gravity_mps2 = {9.80665, 1e-6}};

/// How many 95 % intervals contain the truth.
struct Coverage {
  int inside = 0, all = 0;
  void add(double value, double std, double truth) {
    inside += std::abs(value - truth) <= 1.959964 * std ? 1 : 0;
    ++all;
  }
  [[nodiscard]] double share() const { return static_cast<double>(inside) / all; }
};

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

/// A base that does not rotate, with a slow level acceleration (a sine of 1.2 m/s², 0.02 to 0.1 Hz)
/// beside white vibration; with gyroscope.
inline MovingBase slowly_swayed_base(double vibration_mps2, std::uint64_t seed) {
  return moving_base({.samples = 6000,
                      .accel_std_mps2 = 0.0,
                      .sway_mps2 = 1.2,
                      .fastest_sway_hz = 0.1,
                      .turning = 0.0,
                      .reading_std_mps2 = vibration_mps2},
                     seed);
}

/// A second simulator: roll and pitch, the acceleration of the base along one horizontal direction
/// and its vibration are sums of six sines, 60 s at 100 Hz with white noise of 0.02 m/s². The other
/// table in docs/methods/tilt.md.
struct Swing {
  const char* name;
  double turning_rad = 0.0, fastest_turning_hz = 0.5;  ///< root mean square of roll; half for pitch
  double accel_mps2 = 0.0, slowest_hz = 0.02, fastest_hz = 0.2;
  double vibration_mps2 = 0.0;  ///< 5 to 40 Hz, on each axis
  double rest_s = 0.0;          ///< at either end
  bool gyroscope = false;
  double least = 0.93;  ///< minimum coverage by the smoother
};

inline void PrintTo(const Swing& swing, std::ostream* out) {
  *out << swing.name;
}

class Sines {
 public:
  Sines(Random& random, double rms, double slowest_hz, double fastest_hz)
      : amplitude_(rms / std::sqrt(0.5 * static_cast<double>(waves_.size()))) {
    for (Wave& wave : waves_)
      wave = {rad_per_turn * slowest_hz * std::pow(fastest_hz / slowest_hz, random.unit()),
              random.phase()};
  }
  [[nodiscard]] double at(double time_s) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::sin(wave.radps * time_s + wave.phase);
    return amplitude_ * sum;
  }

 private:
  struct Wave {
    double radps = 0.0, phase = 0.0;
  };
  std::array<Wave, 6> waves_{};
  double amplitude_;
};

inline MovingBase swung(const Swing& swing, std::uint64_t seed) {
  constexpr double duration_s = 60.0, step_s = 0.01, gravity_mps2 = 9.80665, onset_s = 1.0;
  Random random(seed, "swung tilt");
  const Sines roll(random, swing.turning_rad, 0.05, swing.fastest_turning_hz);
  const Sines pitch(random, 0.5 * swing.turning_rad, 0.05, swing.fastest_turning_hz);
  const Sines accel(random, swing.accel_mps2, swing.slowest_hz, swing.fastest_hz);
  const double direction_rad = random.phase();
  std::vector<Sines> shaking;
  for (int axis = 0; axis < 3; ++axis)
    shaking.emplace_back(random, swing.vibration_mps2, 5.0, 40.0);
  const auto strength = [&](double t) {
    const double from_rest_s = std::min(t, duration_s - t) - swing.rest_s;
    return swing.rest_s > 0.0 ? std::clamp(from_rest_s / onset_s, 0.0, 1.0) : 1.0;
  };
  const auto attitude = [&](double t) {  // from level to sensor axes
    return Mat<3, 3>(rotation_by({-strength(t) * roll.at(t), 0.0, 0.0}) *
                     rotation_by({0.0, -strength(t) * pitch.at(t), 0.0}));
  };
  const auto noise = [&](double std) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Mat<3>(std * x, std * y, std * z);
  };
  const Mat<3> rate_bias_radps = noise(0.01);
  MovingBase out;
  for (double t = 0.0; t < duration_s; t += step_s) {
    const Mat<3, 3> A = attitude(t);
    const Mat<3> along(std::cos(direction_rad), std::sin(direction_rad), 0.0);
    const Mat<3> shaken(shaking[0].at(t), shaking[1].at(t), shaking[2].at(t));
    const Mat<3> up = A.col(2) * gravity_mps2;
    const Mat<3> force =
        up + A * Mat<3>(strength(t) * (accel.at(t) * along + shaken)) + noise(0.02);
    const double h = 1e-4;
    const Mat<3, 3> W = (attitude(t - h) - attitude(t + h)) / (2.0 * h) * A.transpose();  // [ω]×
    const Mat<3> rate = Mat<3>(W(2, 1), W(0, 2), W(1, 0)) + rate_bias_radps + noise(0.01);
    out.add(t, force, swing.gyroscope ? &rate : nullptr, up);
  }
  return out;
}

}  // namespace proofmass::estimate
