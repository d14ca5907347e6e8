#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "proofmass/estimate/track.hpp"

namespace proofmass::estimate {

/// A sensor carried along a line from rest to rest, with minimum-jerk strokes.
struct Carriage {
  std::vector<double> strokes_m{0.4, -0.4, 0.4, -0.4};
  double stroke_s = 1.5, dwell_s = 2.0;
  double rate_hz = 100.0;
  std::array<double, 3> direction{1.0, 0.0, 0.0};
  std::array<double, 3> at_rest_mps2{0.1, -0.2, standard_gravity_mps2};  ///< gravity and bias
  double noise_std_mps2 = 0.02;
  bool harmonic = false;  ///< one motion without rests between the strokes, turning at full force
  std::uint64_t seed = 1;
};

struct CarriageRecord {
  TrackSensor sensor;
  std::vector<double> position_m, velocity_mps, accel_mps2;
};

/// Position, velocity and acceleration at fraction s of a stroke of length 1 in time 1.
inline std::array<double, 3> stroke_shape(double s, bool harmonic) {
  if (harmonic) {
    const double w = std::numbers::pi;
    return {0.5 * (1.0 - std::cos(w * s)), 0.5 * w * std::sin(w * s),
            0.5 * w * w * std::cos(w * s)};
  }
  return {s * s * s * (10.0 - 15.0 * s + 6.0 * s * s), s * s * (30.0 - 60.0 * s + 30.0 * s * s),
          s * (60.0 - 180.0 * s + 120.0 * s * s)};
}

inline CarriageRecord record(const Carriage& carriage) {
  CarriageRecord out;
  out.sensor.name = "carriage";
  std::mt19937_64 engine(carriage.seed);
  std::normal_distribution<double> noise(0.0, carriage.noise_std_mps2);
  double from = 0.0;
  bool moving = false;
  const auto push = [&](double p, double v, double a) {
    out.sensor.time_s.push_back(static_cast<double>(out.sensor.time_s.size()) / carriage.rate_hz);
    out.position_m.push_back(p);
    out.velocity_mps.push_back(v);
    out.accel_mps2.push_back(a);
    for (std::size_t i = 0; i < 3; ++i)
      out.sensor.accel_mps2[i].push_back(carriage.at_rest_mps2[i] + carriage.direction[i] * a +
                                         noise(engine));
  };
  const auto rest = [&](double length_s) {
    for (double t = 0.0; t < length_s * carriage.rate_hz; t += 1.0) push(from, 0.0, 0.0);
  };
  rest(carriage.dwell_s);
  for (const double length : carriage.strokes_m) {
    const double T = carriage.stroke_s, n = T * carriage.rate_hz;
    for (double k = 0.0; k < n; k += 1.0) {
      const auto [p, v, a] = stroke_shape(k / n, carriage.harmonic);
      // A sensor of finite bandwidth measures half of a force that starts at a sample.
      const double onset = carriage.harmonic && !std::exchange(moving, true) ? 0.5 : 1.0;
      push(from + length * p, length * v / T, onset * length * a / (T * T));
    }
    from += length;
    if (!carriage.harmonic) rest(carriage.dwell_s);
  }
  if (carriage.harmonic) {
    // The force does not end abruptly, either.
    for (std::size_t i = 0; i < 3; ++i)
      out.sensor.accel_mps2[i].back() += 0.5 * carriage.direction[i] * out.accel_mps2.back();
    rest(carriage.dwell_s);
  }
  return out;
}

}  // namespace proofmass::estimate
