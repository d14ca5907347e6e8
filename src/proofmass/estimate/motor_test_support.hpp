#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>

#include "proofmass/estimate/motor.hpp"

// A geared drive from first principles, for the tests of motor.hpp: two bodies and an elastic
// contact between them, integrated at 50 kHz, with bristle friction. Shares nothing with the
// estimator, whose gear is rigid, whose friction is a function of the speed, and whose noise is
// white.
namespace proofmass::estimate::motor_test {

/// In coordinates of the load's shaft.
struct TrueDrive {
  double resistance = 13.0, inductance = 0.06, torque_constant = 22.6;
  double brush_drop = 0.0, brush_knee = 0.005;  ///< V; current within which its sign changes, A
  double motor_inertia = 0.6, load_inertia = 0.012;
  double viscous = 0.8;
  double coulomb = 3.0, stribeck = 1.0, stribeck_speed = 0.08;
  double load_coulomb = 0.15;  ///< of the wheel's bearings
  double backlash = 0.012;     ///< rad, full width
  double unbalance = 0.0;      ///< N m
  double cogging = 0.02;       ///< N m, 24 per turn of the motor
  double contact_stiffness = 2e4, contact_damping = 28.0;
  double bristle_stiffness = 2e4, bristle_damping = 60.0;

  [[nodiscard]] double inertia() const { return motor_inertia + load_inertia; }
  [[nodiscard]] double total_coulomb() const { return coulomb + load_coulomb; }
};

struct TrueMeasurement {
  double rate_hz = 200.0, duration_s = 40.0;
  double voltage_noise = 0.02, current_noise = 0.002, accel_noise = 0.0184;
  double voltage_step = 0.0122, current_step = 5e-4;
  double current_offset = 0.0;
  double ripple_v = 1.0, ripple_hz = 937.0;
  double bias = 0.3, scale = 0.005, radius = 0.1, bandwidth_hz = 100.0;
  int sensors = 2;
  double encoder_counts = 0.0;  ///< per turn of the load; 0: accelerometers instead
};

using Voltage = std::function<double(double)>;

/// Reversals at several speeds, slow and fast.
inline double exploring(double t) {
  const double swell = 0.6 + 0.4 * std::sin(2.0 * std::numbers::pi * 0.037 * t);
  constexpr double turn = 2.0 * std::numbers::pi;
  return 26.0 * swell * std::sin(turn * 0.2 * t) + 10.0 * std::sin(turn * 0.03 * t) +
         5.0 * std::sin(turn * 1.3 * t);
}

/// Motions of 3 s with rests of 1 s between, in both directions, fast and slow.
inline double with_rests(double t) {
  const double in_motion = std::fmod(t, 4.0) / 3.0;
  if (in_motion > 1.0) return 0.0;
  const int motion = static_cast<int>(t / 4.0);
  const double rise = std::sin(std::numbers::pi * in_motion);
  return (motion % 2 == 0 ? 1.0 : -1.0) * (10.0 + 14.0 * ((motion * 7) % 5) / 4.0) * rise * rise;
}

class Bodies {
 public:
  explicit Bodies(const TrueDrive& drive) : d_(drive) {}

  void step(double u, double h) {
    const double di = (u - d_.resistance * current - d_.torque_constant * motor_speed -
                       d_.brush_drop * std::tanh(current / d_.brush_knee)) /
                      d_.inductance;
    const double gear = contact();
    const double cogging = d_.cogging * std::sin(24.0 * 58.0 * motor_angle);
    const double motor_torque = d_.torque_constant * current - friction(h) - gear - cogging;
    const double load_torque = gear - d_.load_coulomb * std::tanh(load_speed / 1e-3) -
                               d_.unbalance * std::cos(load_angle + 0.4);
    current += h * di;
    motor_speed += h * motor_torque / d_.motor_inertia;
    load_speed += h * load_torque / d_.load_inertia;
    motor_angle += h * motor_speed;
    load_angle += h * load_speed;
    load_accel = load_torque / d_.load_inertia;
  }

  double current = 0.0, motor_speed = 0.0, load_speed = 0.0, motor_angle = 0.0, load_angle = 0.0,
         load_accel = 0.0;

 private:
  // LuGre: C. Canudas de Wit et al., IEEE Trans. Autom. Control 40 (1995) 419.
  double friction(double h) {
    const double ratio = motor_speed / d_.stribeck_speed;
    const double steady = d_.coulomb + d_.stribeck * std::exp(-ratio * ratio);
    const double slip =
        motor_speed - d_.bristle_stiffness * std::abs(motor_speed) / steady * bristle_;
    bristle_ += h * slip;
    return d_.bristle_stiffness * bristle_ + d_.bristle_damping * slip + d_.viscous * motor_speed;
  }

  [[nodiscard]] double contact() const {
    const double apart = motor_angle - load_angle, half = 0.5 * d_.backlash;
    const double closing = motor_speed - load_speed;
    if (apart > half)
      return std::max(0.0, d_.contact_stiffness * (apart - half) + d_.contact_damping * closing);
    if (apart < -half)
      return std::min(0.0, d_.contact_stiffness * (apart + half) + d_.contact_damping * closing);
    return 0.0;
  }

  TrueDrive d_;
  double bristle_ = 0.0;
};

inline MotorRecord simulated(const TrueDrive& drive,
                             const TrueMeasurement& how,
                             const Voltage& voltage,
                             std::uint64_t seed) {
  constexpr double h = 2e-5, g = 9.80665;
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  MotorRecord out;
  out.accel_mps2.resize(static_cast<std::size_t>(how.sensors));
  std::vector<std::array<double, 4>> errors;  // bias and scale of two axes
  for (int s = 0; s < how.sensors; ++s)
    errors.push_back({how.bias * uniform(engine), how.bias * uniform(engine),
                      1.0 + how.scale * uniform(engine), 1.0 + how.scale * uniform(engine)});
  const double start = std::numbers::pi * uniform(engine);
  double phase =
      std::numbers::pi * uniform(engine);  // of the ripple, which is not locked to the card
  Bodies bodies(drive);
  // The sensors' one-pole filters, from the start at rest.
  std::vector<std::array<double, 2>> filtered(static_cast<std::size_t>(how.sensors));
  const double share = h * 2.0 * std::numbers::pi * how.bandwidth_hz;
  const auto force = [&](int s) {
    const double angle = start + bodies.load_angle + s * std::numbers::pi;
    const double w = bodies.load_speed;
    return std::array{g * std::sin(angle) - how.radius * w * w,
                      g * std::cos(angle) + how.radius * bodies.load_accel};
  };
  for (int s = 0; s < how.sensors; ++s) filtered[static_cast<std::size_t>(s)] = force(s);
  const auto per_sample = static_cast<int>(std::lround(1.0 / (how.rate_hz * h)));
  const auto n = static_cast<int>(how.rate_hz * how.duration_s);
  const auto stepped = [](double x, double lsb) {
    return lsb > 0.0 ? lsb * std::round(x / lsb) : x;
  };
  for (int k = 0; k < n; ++k) {
    double t = 0.0, u = 0.0;
    phase += normal(engine);
    for (int j = 0; j < per_sample; ++j) {
      t = (k * per_sample + j) * h;
      u = voltage(t) + how.ripple_v * std::sin(2.0 * std::numbers::pi * how.ripple_hz * t + phase);
      bodies.step(u, h);
      for (int s = 0; s < how.sensors; ++s)
        for (std::size_t i = 0; i < 2; ++i) {
          double& low = filtered[static_cast<std::size_t>(s)][i];
          low += share * (force(s)[i] - low);
        }
    }
    out.time_s.push_back(k / how.rate_hz);
    // The card's own filter takes most of the ripple off.
    const double seen = voltage(t + h) + 0.1 * (u - voltage(t));
    out.voltage_v.push_back(stepped(seen + how.voltage_noise * normal(engine), how.voltage_step));
    out.current_a.push_back(
        stepped(bodies.current + how.current_offset + how.current_noise * normal(engine),
                how.current_step));
    if (how.encoder_counts > 0.0) {
      const double count_rad = 2.0 * std::numbers::pi / how.encoder_counts;
      out.angle_rad.push_back(count_rad * std::floor(bodies.load_angle / count_rad));
    }
    for (int s = 0; s < how.sensors; ++s) {
      auto& axes = out.accel_mps2[static_cast<std::size_t>(s)];
      const auto& e = errors[static_cast<std::size_t>(s)];
      axes[0].push_back(e[2] * filtered[static_cast<std::size_t>(s)][0] + e[0] +
                        how.accel_noise * normal(engine));
      axes[1].push_back(e[3] * filtered[static_cast<std::size_t>(s)][1] + e[1] +
                        how.accel_noise * normal(engine));
      axes[2].push_back(e[0] + how.accel_noise * normal(engine));
    }
  }
  return out;
}

}  // namespace proofmass::estimate::motor_test
