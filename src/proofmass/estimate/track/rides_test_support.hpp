#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "proofmass/estimate/track.hpp"

// Random rides of lifts, carts and slides with known true positions: the measurements are second
// differences at 1 kHz.
namespace proofmass::estimate::rides {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53;
  }
  double sign() { return between(0.0, 1.0) < 0.5 ? -1.0 : 1.0; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(between(0.0, 1.0)));
    return radius * std::cos(2.0 * std::numbers::pi * between(0.0, 1.0));
  }

 private:
  std::mt19937_64 bits_;
};

/// The speed changes to `to_mps` within `duration_s`: the acceleration rises and falls along half
/// cosines that take `eased` of the time together, and is constant in between.
struct Leg {
  double duration_s, to_mps, eased = 0.4;
};

struct Ride {
  double start_mps = 0.0;
  std::vector<Leg> legs;
  std::size_t axis = 2;
  double noise_mps2 = 0.03;
  double moving_noise_mps2 = 0.0;  ///< additional noise while the speed is not 0
  double floor_tilt_rad = 0.0;     ///< root mean square, about an axis across the motion
  bool has_gyro = false;           ///< with a bias; on a level floor
};

struct RideRecord {
  TrackSensor sensor;
  double displacement_m = 0.0;
};

/// Completed fraction of the speed change at fraction s of a leg.
inline double done(double s, double eased) {
  // Mean of a step with ease-in and one with ease-out, by integration of the profile.
  constexpr int steps = 200;
  static thread_local std::vector<double> table;
  static thread_local double of = -1.0;
  if (of != eased) {
    table.assign(steps + 1, 0.0);
    const auto accel = [&](double at) {
      const double ramp = 0.5 * eased, edge = std::min(at, 1.0 - at);
      return edge >= ramp ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * edge / ramp));
    };
    for (int i = 1; i <= steps; ++i)
      table[static_cast<std::size_t>(i)] =
          table[static_cast<std::size_t>(i) - 1] + accel((i - 0.5) / steps);
    for (double& value : table) value /= table.back();
    of = eased;
  }
  const double at = std::clamp(s, 0.0, 1.0) * steps;
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(steps - 1));
  return std::lerp(table[i], table[i + 1], at - static_cast<double>(i));
}

/// The tilt of a floor as a function of the position: four waves of 0.7 to 6 m.
class Floor {
 public:
  Floor(double tilt_rad, Draw& draw) {
    if (tilt_rad == 0.0) return;
    for (Wave& wave : waves_)
      wave = {tilt_rad * std::numbers::sqrt2 / 2.0, 2.0 * std::numbers::pi / draw.between(0.7, 6.0),
              2.0 * std::numbers::pi * draw.between(0.0, 1.0)};
  }
  [[nodiscard]] double tilt_rad(double position_m) const {
    double sum = 0.0;
    for (const Wave& wave : waves_)
      sum += wave.amplitude_rad * std::sin(wave.per_m * position_m + wave.phase_rad);
    return sum;
  }

 private:
  struct Wave {
    double amplitude_rad = 0.0, per_m = 0.0, phase_rad = 0.0;
  };
  std::array<Wave, 4> waves_{};
};

/// At 100 Hz, with biases of some cm/s² and gravity along z where the floor is level.
inline RideRecord record(const Ride& ride, Draw& draw) {
  constexpr double step_s = 1e-3;
  constexpr int each = 10;
  std::vector<double> speed{ride.start_mps};
  for (const Leg& leg : ride.legs) {
    const double from = speed.back();
    const auto count = static_cast<int>(std::lround(leg.duration_s / step_s));
    for (int i = 1; i <= count; ++i)
      speed.push_back(from + (leg.to_mps - from) * done(static_cast<double>(i) / count, leg.eased));
  }
  std::array<double, 3> level{};
  for (double& bias : level) bias = 0.05 * draw.normal();
  const Floor floor(ride.floor_tilt_rad, draw);
  RideRecord out;
  out.sensor.name = "ride";
  for (std::size_t k = 1; k + 1 < speed.size(); ++k) {
    out.displacement_m += 0.5 * step_s * (speed[k - 1] + speed[k]);
    if (k % each != 1) continue;
    out.sensor.time_s.push_back(static_cast<double>(k) * step_s);
    const double accel = (speed[k + 1] - speed[k - 1]) / (2.0 * step_s);
    const double shaking = speed[k] != 0.0 ? ride.moving_noise_mps2 : 0.0;
    const double tilt_rad = floor.tilt_rad(out.displacement_m);
    std::array<double, 3> force{0.0, 0.0, standard_gravity_mps2 * std::cos(tilt_rad)};
    force[ride.axis] += accel + standard_gravity_mps2 * std::sin(tilt_rad);
    for (std::size_t a = 0; a < 3; ++a)
      out.sensor.accel_mps2[a].push_back(level[a] + force[a] +
                                         std::hypot(ride.noise_mps2, shaking) * draw.normal());
  }
  if (!ride.has_gyro) return out;
  for (auto& rates : out.sensor.rate_radps) {
    const double bias_radps = 0.01 * draw.normal();
    for (std::size_t k = 0; k < out.sensor.time_s.size(); ++k)
      rates.push_back(bias_radps + 0.002 * draw.normal());
  }
  return out;
}

/// Successive rides of a lift with stops between, in a cabin with vibration of `ratio` times the
/// sensor's noise.
inline Ride lift(Draw& draw, int rides, double ratio) {
  Ride ride;
  ride.moving_noise_mps2 = ratio * ride.noise_mps2;
  ride.legs.push_back({draw.between(3.0, 6.0), 0.0});
  for (int i = 0; i < rides; ++i) {
    const double speed = draw.between(1.0, 3.0) * (rides == 1 ? draw.sign() : 1.0);
    ride.legs.push_back({draw.between(2.5, 4.0), speed});
    ride.legs.push_back({draw.between(1.0, 30.0), speed});
    ride.legs.push_back({draw.between(2.5, 4.0), 0.0});
    ride.legs.push_back({draw.between(4.0, 8.0), 0.0});
  }
  return ride;
}

inline Ride cart(Draw& draw) {
  Ride ride;
  ride.axis = 0;
  const double speed = draw.between(0.3, 1.0) * draw.sign();
  ride.legs = {{draw.between(2.0, 4.0), 0.0},
               {draw.between(0.5, 1.0), speed, 1.0},
               {draw.between(2.0, 10.0), speed},
               {draw.between(0.5, 1.0), 0.0, 1.0},
               {draw.between(2.0, 4.0), 0.0}};
  return ride;
}

/// One ride on a level track, as quiet while the acceleration is constant as at rest or louder.
inline Ride train(Draw& draw, double ratio) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.01, 0.03);
  ride.moving_noise_mps2 = ratio * ride.noise_mps2;
  const double speed = draw.between(5.0, 20.0) * draw.sign();
  ride.legs = {{draw.between(5.0, 10.0), 0.0},
               {std::abs(speed) / draw.between(0.4, 1.1), speed, 0.2},
               {draw.between(10.0, 40.0), speed},
               {std::abs(speed) / draw.between(0.4, 1.1), 0.0, 0.2},
               {draw.between(5.0, 10.0), 0.0}};
  return ride;
}

/// The recording begins at full speed.
inline Ride begun_under_way(Draw& draw) {
  Ride ride;
  ride.start_mps = draw.between(1.0, 3.0) * draw.sign();
  ride.legs = {{draw.between(4.0, 10.0), ride.start_mps},
               {draw.between(2.5, 4.0), 0.0},
               {draw.between(4.0, 8.0), 0.0}};
  return ride;
}

/// Random motion back and forth along one axis, between two rests.
inline Ride shaken(Draw& draw) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.005, 0.05);
  ride.legs.push_back({draw.between(2.0, 4.0), 0.0});
  const double until_s = draw.between(4.0, 20.0);
  for (double t = 0.0; t < until_s;) {
    const double leg_s = draw.between(0.3, 1.5);
    ride.legs.push_back({leg_s, draw.between(0.1, 0.8) * draw.sign(), 1.0});
    t += leg_s;
  }
  ride.legs.push_back({0.6, 0.0, 1.0});
  ride.legs.push_back({draw.between(2.0, 4.0), 0.0});
  return ride;
}

/// Slow enough for the acceleration to remain within the noise.
inline Ride slow_slide(Draw& draw) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.01, 0.05);
  const double half_s = draw.between(4.0, 12.0);
  const double speed = draw.between(0.1, 0.6) * ride.noise_mps2 * half_s / 1.6 * draw.sign();
  ride.legs = {{draw.between(2.0, 4.0), 0.0},
               {half_s, speed, 1.0},
               {half_s, 0.0, 1.0},
               {draw.between(2.0, 4.0), 0.0}};
  return ride;
}

/// Six strokes of 0.2 m, each with a duration of about `stroke_s`.
inline Ride strokes(Draw& draw, double stroke_s) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.01, 0.04);
  for (int i = 0; i < 6; ++i) {
    const double half_s = 0.5 * stroke_s * draw.between(0.8, 1.3);
    ride.legs.push_back({2.0, 0.0});
    ride.legs.push_back({half_s, (i % 2 == 0 ? 0.2 : -0.2) / half_s, 1.0});
    ride.legs.push_back({half_s, 0.0, 1.0});
  }
  ride.legs.push_back({2.0, 0.0});
  return ride;
}

/// Eight strokes of 0.4 m back and forth, each in 1 to 4 s, with rests of 1.2 s between: most of
/// the recording is as quiet as rest.
inline Ride slow_strokes(Draw& draw) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.01, 0.05);
  ride.legs.push_back({3.0, 0.0});
  for (int i = 0; i < 8; ++i) {
    const double half_s = 0.5 * draw.between(1.0, 4.0);
    ride.legs.push_back({half_s, (i % 2 == 0 ? 0.4 : -0.4) / half_s, 1.0});
    ride.legs.push_back({half_s, 0.0, 1.0});
    ride.legs.push_back({i < 7 ? 1.2 : 3.0, 0.0});
  }
  return ride;
}

/// One to four slow moves in one direction, 0.1 to 0.5 m in 4 to 10 s, with pauses between: in most
/// of each the acceleration is nearly constant, and little above the noise.
inline Ride slow_moves(Draw& draw) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = 0.01;
  ride.legs.push_back({draw.between(1.5, 4.0), 0.0});
  const int count = static_cast<int>(draw.between(1.0, 5.0));
  for (int i = 0; i < count; ++i) {
    const double half_s = 0.5 * draw.between(4.0, 10.0);
    const double eased = draw.between(0.3, 1.0);
    ride.legs.push_back({half_s, draw.between(0.1, 0.5) / half_s, eased});
    ride.legs.push_back({half_s, 0.0, eased});
    ride.legs.push_back({draw.between(1.5, 4.0), 0.0});
  }
  return ride;
}

template <class Make>
auto with_gyro(Make make) {
  return [make](Draw& draw) {
    Ride ride = make(draw);
    ride.has_gyro = true;
    return ride;
  };
}

/// Two to six strokes of 0.3 to 1.5 m over a floor that is not level.
inline Ride over_a_floor(Draw& draw, double tilt_rad) {
  Ride ride;
  ride.axis = 0;
  ride.noise_mps2 = draw.between(0.005, 0.03);
  ride.floor_tilt_rad = tilt_rad;
  ride.legs.push_back({draw.between(2.0, 4.0), 0.0});
  const int count = static_cast<int>(draw.between(2.0, 7.0));
  for (int i = 0; i < count; ++i) {
    const double half_s = 0.5 * draw.between(1.5, 4.0);
    const double speed = draw.between(0.3, 1.5) / half_s * draw.sign();
    ride.legs.push_back({half_s, speed, 1.0});
    ride.legs.push_back({half_s, 0.0, 1.0});
    ride.legs.push_back({draw.between(1.5, 3.0), 0.0});
  }
  return ride;
}

/// Coverage of the intervals over many recordings.
struct Held {
  int recordings = 0, given = 0, held = 0, wrong = 0;  ///< wrong: off by more than 5 std
  double squares = 0.0;                                ///< of the errors, m²
  double largest = 0.0;                                ///< error over standard deviation

  void add(const std::optional<TrackMethod>& said, double truth_m) {
    ++recordings;
    if (!said) return;
    ++given;
    const double off = said->displacement_m.value - truth_m;
    held += std::abs(off) <= said->half_width_95_m ? 1 : 0;
    const double ratio = std::abs(off) / said->displacement_m.std;
    wrong += ratio > 5.0 ? 1 : 0;
    largest = std::max(largest, ratio);
    squares += off * off;
  }
  [[nodiscard]] double share() const { return given > 0 ? static_cast<double>(held) / given : 1.0; }
  [[nodiscard]] double rms_m() const { return given > 0 ? std::sqrt(squares / given) : 0.0; }
};

template <class Make>
Held held_by(const Make& make, std::uint64_t first, int count) {
  Held all;
  for (int i = 0; i < count; ++i) {
    Draw draw(first + static_cast<std::uint64_t>(i));
    const Ride ride = make(draw);
    const RideRecord made = record(ride, draw);
    TrackOptions options;
    options.scale_std = 0.0;
    options.axis = std::array<double, 3>{};
    (*options.axis)[ride.axis] = 1.0;
    const auto found = estimate_track(made.sensor, options);
    all.add(found ? found->smoother : std::nullopt, made.displacement_m);
  }
  return all;
}

}  // namespace proofmass::estimate::rides
