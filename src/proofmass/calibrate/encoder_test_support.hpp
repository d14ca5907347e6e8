#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "proofmass/calibrate/encoder.hpp"

// A wheel with accelerometers and an encoder, from positions: the rim's points are moved, and
// differenced twice. It shares nothing with the fit.
namespace proofmass::calibrate::test {

struct SimulatedEncoder {
  double rate_hz = 200.0, seconds = 120.0;
  std::function<double(double)> speed_radps = [](double) { return 1.152; };
  std::vector<std::array<double, 3>> ripples;  ///< cycles a turn, relative amplitude, phase
  int counts_per_turn = 4096;
  double eccentricity = 0.005, eccentricity_phase = 0.4;  ///< of the disc's centre, of its radius
  double warp_rad = 0.001, warp_phase = 1.1;              ///< cos(2θ + phase)
  double third_rad = 0.0;
  std::vector<std::array<double, 2>> missed;  ///< time in s, counts lost
  /// One accelerometer each: lever arm in m along the wheel's marks, mounting angle.
  std::vector<std::array<double, 3>> sensors{{0.1, 0.0, 0.3}};
  double noise_mps2 = 0.0184, slow_mps2 = 0.003, bias_mps2 = 0.3, warm_up_mps2 = 0.05;
  double scale_std = 0.02, square_std = 0.0, lsb_mps2 = 0.0024, pole_hz = 50.0;
  double runout_m = 0.0;
  bool edges = false;  ///< stamped edges instead of sampled counts
};

struct EncoderTruth {
  std::array<double, 4> errors{};  ///< c1 s1 c2 s2
};

inline double disc_angle(const SimulatedEncoder& wheel, double angle) {
  // The disc's centre is off the axle by this part of its radius; the head sees the angle about it.
  const double towards = angle + wheel.eccentricity_phase;
  const double seen = std::atan2(-wheel.eccentricity * std::sin(towards),
                                 1.0 - wheel.eccentricity * std::cos(towards));
  return angle - seen + wheel.warp_rad * std::cos(2.0 * angle + wheel.warp_phase) +
         wheel.third_rad * std::cos(3.0 * angle);
}

inline EncoderTruth truth_of(const SimulatedEncoder& wheel) {
  const double a = wheel.eccentricity, b = wheel.eccentricity_phase, half = 0.5 * a * a;
  return {{a * std::sin(b), a * std::cos(b),
           wheel.warp_rad * std::cos(wheel.warp_phase) + half * std::sin(2.0 * b),
           -wheel.warp_rad * std::sin(wheel.warp_phase) + half * std::cos(2.0 * b)}};
}

/// One channel: an axis of an accelerometer, with its errors and its filter.
struct SimulatedAxis {
  double bias, scale, second, third, cross, filtered = 0.0, slow = 0.0;
};

inline EncoderRecording simulate(const SimulatedEncoder& wheel, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(0.0, 2.0 * std::numbers::pi);
  constexpr int fine = 8;
  constexpr double g = 9.80665;
  const double dt = 1.0 / (wheel.rate_hz * fine);
  EncoderRecording out;
  out.name = "simulated";
  out.step_rad = 2.0 * std::numbers::pi / wheel.counts_per_turn;
  out.has_index = true;
  const std::size_t axes = 2 * wheel.sensors.size();
  out.axes.resize(axes);
  std::vector<SimulatedAxis> sensor;
  for (std::size_t k = 0; k < axes; ++k) {
    out.axis_names.push_back("a" + std::to_string(k));
    out.sensor_of.push_back(k / 2);
    sensor.push_back({wheel.bias_mps2 * normal(random), 1.0 + wheel.scale_std * normal(random),
                      wheel.square_std * normal(random), wheel.square_std * normal(random),
                      wheel.square_std * normal(random)});
  }
  const double skew = 0.01 * normal(random);
  const double wobble_1 = turn(random), wobble_2 = turn(random);
  const auto speed = [&](double t, double angle) {
    double ripple = 1.0;
    for (const auto& [n, size, phase] : wheel.ripples) ripple += size * std::cos(n * angle + phase);
    return wheel.speed_radps(t) * ripple;
  };
  const auto point = [&](double angle, const std::array<double, 3>& at) {
    const double c = std::cos(angle), s = std::sin(angle);
    return std::array{wheel.runout_m * std::cos(angle + wobble_1) + c * at[0] - s * at[1],
                      wheel.runout_m * std::sin(angle + wobble_2) + s * at[0] + c * at[1]};
  };
  double angle = turn(random), time = 0.0;
  std::array<double, 3> angles{angle, angle, angle};  // of the last three fine steps
  std::vector<double> stamps, counts;
  double lost = 0.0, last_count = 0.0;
  bool first = true;
  const auto steps = static_cast<long>(wheel.seconds * wheel.rate_hz * fine);
  const double keep = std::exp(-2.0 * std::numbers::pi * wheel.pole_hz * dt);
  for (long step = 0; step < steps; ++step) {
    // Heun's method.
    const double k1 = speed(time, angle), k2 = speed(time + dt, angle + dt * k1);
    angle += 0.5 * dt * (k1 + k2);
    time += dt;
    angles = {angles[1], angles[2], angle};
    lost = 0.0;
    for (const auto& [at, size] : wheel.missed) lost += time > at ? size : 0.0;
    const double count = std::floor(disc_angle(wheel, angle) / out.step_rad) - lost;
    if (wheel.edges && !first && count != last_count) {
      stamps.push_back(time - 0.5 * dt);
      counts.push_back(count * out.step_rad);
    }
    first = false;
    last_count = count;
    if (step < 2) continue;
    for (std::size_t s = 0; s < wheel.sensors.size(); ++s) {
      const auto before = point(angles[0], wheel.sensors[s]),
                 now = point(angles[1], wheel.sensors[s]),
                 after = point(angles[2], wheel.sensors[s]);
      const double ax = (after[0] - 2.0 * now[0] + before[0]) / (dt * dt);
      const double ay = (after[1] - 2.0 * now[1] + before[1]) / (dt * dt) + g;
      const double c = std::cos(angles[1] + wheel.sensors[s][2]),
                   d = std::sin(angles[1] + wheel.sensors[s][2]);
      const std::array force{c * ax + d * ay, -d * ax + c * ay + skew * (c * ax + d * ay)};
      for (std::size_t k = 0; k < 2; ++k) {
        SimulatedAxis& one = sensor[2 * s + k];
        const double u = force[k] / g, v = force[1 - k] / g;
        const double bent = u + one.second * u * u + one.third * u * u * u + one.cross * u * v;
        const double output = one.bias + one.scale * g * bent;
        one.filtered = step == 2 ? output : output + keep * (one.filtered - output);
      }
    }
    if (step % fine != 0) continue;
    out.time_s.push_back(time - dt);
    for (std::size_t k = 0; k < axes; ++k) {
      SimulatedAxis& one = sensor[k];
      // Coloured noise with a time constant of 2 s.
      const double held = std::exp(-1.0 / (2.0 * wheel.rate_hz));
      one.slow = held * one.slow + wheel.slow_mps2 * std::sqrt(1.0 - held * held) * normal(random);
      const double value = one.filtered + one.slow + wheel.noise_mps2 * normal(random) +
                           wheel.warm_up_mps2 * (1.0 - std::exp(-time / 60.0));
      out.axes[k].push_back(std::round(value / wheel.lsb_mps2) * wheel.lsb_mps2);
    }
    if (!wheel.edges)
      counts.push_back((std::floor(disc_angle(wheel, angles[1]) / out.step_rad) - lost) *
                       out.step_rad);
  }
  out.encoder = wheel.edges ? signal::fixes_of_edges(stamps, counts, out.step_rad, 1e-6)
                            : signal::fixes_of_samples(out.time_s, counts, out.step_rad, 0.0);
  return out;
}

}  // namespace proofmass::calibrate::test
