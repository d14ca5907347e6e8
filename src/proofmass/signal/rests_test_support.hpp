#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "proofmass/signal/rests.hpp"

namespace proofmass::signal::rests_test {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double pi = std::numbers::pi;

using Vector = std::array<double, 3>;

/// Noise generators with the same numbers on every platform.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }
  double normal() { return std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * pi * uniform()); }
  Vector direction() {
    const double z = 2.0 * uniform() - 1.0;
    const double angle = 2.0 * pi * uniform();
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937_64 engine_;
};

/// Synthetic measurements of a sensor placed in one position after another, gravity 9.81.
struct Session {
  double rate_hz = 100.0;
  std::array<std::vector<double>, 3> axis{};
  std::vector<Rest> rests{};  ///< the truth
  Vector up{0.0, 0.0, 1.0};

  [[nodiscard]] std::size_t size() const { return axis[0].size(); }
  [[nodiscard]] std::size_t samples(double seconds) const {
    return static_cast<std::size_t>(std::round(seconds * rate_hz));
  }
  void add(const Vector& force) {
    for (std::size_t a = 0; a < 3; ++a) axis[a].push_back(force[a]);
  }
  void rest(double seconds) {
    const std::size_t first = size();
    for (std::size_t k = 0; k < samples(seconds); ++k)
      add({9.81 * up[0], 9.81 * up[1], 9.81 * up[2]});
    rests.push_back({first, size() - 1});
  }
  /// Turns at a constant rate to another position, with vibration up to `shake`.
  void turn(double seconds, Noise& noise, double shake = 1.0) {
    const Vector from = up;
    do up = noise.direction();
    while (from[0] * up[0] + from[1] * up[1] + from[2] * up[2] > 0.7);
    const std::size_t count = samples(seconds);
    const Vector way = noise.direction();
    for (std::size_t k = 0; k < count; ++k) {
      const double done = static_cast<double>(k + 1) / static_cast<double>(count + 1);
      const double vibration = shake * std::sin(40.0 * done) + 0.5 * shake * std::sin(97.0 * done);
      Vector force{};
      for (std::size_t a = 0; a < 3; ++a)
        force[a] = 9.81 * ((1.0 - done) * from[a] + done * up[a]) + vibration * way[a];
      add(force);
    }
  }
  void add_noise(double std, Noise& noise) {
    for (std::vector<double>& values : axis)
      for (double& value : values) value += std * noise.normal();
  }
  [[nodiscard]] RestSearch search(std::size_t axes = 3) const {
    std::vector<View<double>> views(axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(axes));
    return find_rests(views, {.rate_hz = rate_hz});
  }
};

inline Session session(double rate_hz, const std::vector<double>& rests_s, Noise& noise) {
  Session made{.rate_hz = rate_hz};
  for (std::size_t k = 0; k < rests_s.size(); ++k) {
    if (k > 0) made.turn(1.0 + noise.uniform(), noise);
    made.rest(rests_s[k]);
  }
  return made;
}

inline constexpr double noise_std = 0.004;

}  // namespace proofmass::signal::rests_test
