#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "proofmass/estimate/wheel.hpp"

// Test recordings of wheels, by kinematics in the complex plane, independent of wheel/model.hpp.
namespace proofmass::estimate::test {

constexpr double pi = std::numbers::pi;
constexpr double rpm = 2.0 * pi / 60.0;

/// Normal deviates that are identical on every platform (std::normal_distribution is not).
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * pi * uniform());
  }

 private:
  std::mt19937_64 bits_;
};

struct Turning {
  double angle_rad = 0.0, speed_radps = 0.0, accel_radps2 = 0.0;
};

/// The speed changes to `to_radps` within `duration_s`, along half a cosine.
struct Stage {
  double duration_s = 0.0, to_radps = 0.0;
};

struct Drive {
  Turning start;
  std::vector<Stage> stages;
  double ripple = 0.0, ripple_phase_rad = 0.0;  ///< ripple relative to the first speed, once per
                                                ///< turn at that speed

  [[nodiscard]] double duration_s() const {
    double sum = 0.0;
    for (const Stage& stage : stages) sum += stage.duration_s;
    return sum;
  }

  [[nodiscard]] Turning at(double t_s) const {
    Turning now = start;
    double left = t_s;
    for (const Stage& stage : stages) {
      const double T = stage.duration_s, t = std::min(left, T),
                   half = 0.5 * (stage.to_radps - now.speed_radps);
      now.angle_rad += (now.speed_radps + half) * t - half * T / pi * std::sin(pi * t / T);
      now.accel_radps2 = half * pi / T * std::sin(pi * t / T);
      now.speed_radps += half * (1.0 - std::cos(pi * t / T));
      left -= t;
      if (left <= 0.0) break;
    }
    const double w = start.speed_radps, phase = w * t_s + ripple_phase_rad;
    if (ripple != 0.0) {
      now.angle_rad += ripple * (std::cos(ripple_phase_rad) - std::cos(phase));
      now.speed_radps += ripple * w * std::sin(phase);
      now.accel_radps2 += ripple * w * w * std::cos(phase);
    }
    return now;
  }

  [[nodiscard]] double turns(double from_s, double to_s) const {
    return (at(to_s).angle_rad - at(from_s).angle_rad) / (2.0 * pi);
  }
};

/// One sensor with its mounting and errors. `x y z` are its own axes.
struct Mount {
  std::complex<double> place_m{0.1, 0.0};  ///< in the wheel's axes
  double turned_rad = 0.0;                 ///< angle of its u relative to the wheel's first axis
  std::array<double, 2> bias_mps2{}, scale{1.0, 1.0};
  double skew_rad = 0.0;
  double noise_mps2 = 0.02;
  double warm_up_mps2 = 0.0, warm_up_s = 20.0;  ///< exponential change of both biases
  /// Directions of the wheel's u, v and axle in the sensor's axes.
  std::array<std::array<double, 3>, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double clock_offset_s = 0.0;
  bool two_axes = false;
};

struct Site {
  double gravity_mps2 = standard_gravity_mps2;
  double axle_tilt_rad = 0.0;     ///< inclination of the axle
  double rolling_radius_m = 0.0;  ///< 0: fixed axle
};

/// Specific force in the sensor's true u, v: that of a point at p in the complex plane is p̈ + i g
/// with p = p₀ exp(iθ), rotated to the sensor's axes.
inline std::complex<double> force(const Turning& now, const Mount& mount, const Site& site) {
  using namespace std::complex_literals;
  const std::complex<double> turn = std::polar(1.0, now.angle_rad);
  const double w = now.speed_radps, al = now.accel_radps2;
  const std::complex<double> p_ddot =
      (1i * al - w * w) * mount.place_m * turn - site.rolling_radius_m * al;
  const double g = site.gravity_mps2 * std::cos(site.axle_tilt_rad);
  return (p_ddot + 1i * g) * std::conj(turn * std::polar(1.0, mount.turned_rad));
}

/// The two measurements without noise.
inline std::array<double, 2> reading(const std::complex<double>& f, const Mount& mount) {
  return {mount.scale[0] * (f.real() + mount.skew_rad * f.imag()) + mount.bias_mps2[0],
          mount.scale[1] * (f.imag() + mount.skew_rad * f.real()) + mount.bias_mps2[1]};
}

inline WheelSensor record(const Drive& drive,
                          const Mount& mount,
                          double rate_hz,
                          std::uint64_t seed,
                          const Site& site = {}) {
  Normal normal(seed);
  WheelSensor sensor;
  sensor.name = "sensor";
  const auto count = static_cast<std::size_t>(std::floor(drive.duration_s() * rate_hz + 1e-9)) + 1;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) / rate_hz;
    sensor.time_s.push_back(t + mount.clock_offset_s);
    const auto uv = reading(force(drive.at(t), mount, site), mount);
    const double warm = mount.warm_up_mps2 * (1.0 - std::exp(-t / mount.warm_up_s));
    const std::array<double, 3> f{
        uv[0] + warm + mount.noise_mps2 * normal(), uv[1] + warm + mount.noise_mps2 * normal(),
        site.gravity_mps2 * std::sin(site.axle_tilt_rad) + mount.noise_mps2 * normal()};
    for (std::size_t axis = 0; axis < (mount.two_axes ? 2U : 3U); ++axis)
      sensor.accel_mps2[axis].push_back(f[0] * mount.axes[0][axis] + f[1] * mount.axes[1][axis] +
                                        f[2] * mount.axes[2][axis]);
  }
  return sensor;
}

/// The same with a gyroscope: spin about the inclined axle and, at `vehicle_radps(t)`, the vehicle
/// about the vertical, whose direction rotates in the wheel's plane.
template <class Rate>
WheelSensor record_with_gyroscope(const Drive& drive,
                                  const Mount& mount,
                                  double rate_hz,
                                  const Site& site,
                                  const Rate& vehicle_radps) {
  constexpr double noise_radps = 0.01;
  WheelSensor sensor = record(drive, mount, rate_hz, 3, site);
  Normal normal(5);
  const double up = std::sin(site.axle_tilt_rad), across = std::cos(site.axle_tilt_rad);
  for (const double t : sensor.time_s) {
    const Turning now = drive.at(t);
    const double vehicle = vehicle_radps(t);
    const std::array<double, 3> rate{vehicle * across * std::sin(now.angle_rad),
                                     vehicle * across * std::cos(now.angle_rad),
                                     now.speed_radps + vehicle * up};
    for (std::size_t axis = 0; axis < 3; ++axis)
      sensor.rate_radps[axis].push_back(rate[axis] + noise_radps * normal());
  }
  return sensor;
}

/// A wheel pushed by hand a dozen times, from rest to rest.
inline Drive pushes() {
  Drive drive{{0.3, 0.0}, {{2.0, 0.0}}, 0.0, 0.0};
  for (int push = 0; push < 12; ++push) {
    drive.stages.push_back({0.25, 6.5});
    drive.stages.push_back({1.2, 4.0});
  }
  drive.stages.push_back({3.0, 0.0});
  drive.stages.push_back({2.0, 0.0});
  return drive;
}

/// The sensor's axes turned by Euler angles about z, then y, then x.
inline std::array<std::array<double, 3>, 3> tilted(double about_z, double about_y, double about_x) {
  const double cz = std::cos(about_z), sz = std::sin(about_z), cy = std::cos(about_y),
               sy = std::sin(about_y), cx = std::cos(about_x), sx = std::sin(about_x);
  return {{{cz * cy, sz * cy, -sy},
           {cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx},
           {cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx}}};
}

/// Corrupts a row, like a faulty transfer.
inline void spoil(WheelSensor& sensor, std::size_t row, double value) {
  for (auto& axis : sensor.accel_mps2)
    if (!axis.empty()) axis[row] = value;
}

}  // namespace proofmass::estimate::test
