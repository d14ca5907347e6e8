#include "wheel_world.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>

#include "proofmass/core/random.hpp"

namespace proofmass::wheel_world {
namespace {

using Vec3 = std::array<double, 3>;

constexpr double pi = std::numbers::pi;
constexpr double step_s = 1e-4;
constexpr std::array ripple_orders{1.0, 2.0, 7.0};

double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// 0 to 1 along half a cosine.
double eased(double share) {
  if (share <= 0.0) return 0.0;
  if (share >= 1.0) return 1.0;
  return 0.5 * (1.0 - std::cos(pi * share));
}

/// The commanded speed.
class Command {
 public:
  Command(const World& world, std::uint64_t seed) : world_(world) {
    Random random(seed, "command");
    for (double& phase : phase_) phase = random.phase();
    for (double& period : period_s_) period = 3.0 + 12.0 * random.unit();
    if (world.course == Course::pushes) {
      double t = 2.0 + random.unit();
      while (t < world.duration_s - 3.0) {
        pushes_.push_back({t, 0.8 + 0.4 * random.unit()});
        t += 0.9 + 0.4 * random.unit();
      }
    }
  }

  [[nodiscard]] double at(double t) const {
    const double T = world_.duration_s, slow = world_.slow_radps, fast = world_.fast_radps;
    switch (world_.course) {
      case Course::constant:
        return slow;
      case Course::two_speeds:
        return slow + (fast - slow) * eased((t - 0.4 * T) / (0.15 * T));
      case Course::ramp:
        return slow + (fast - slow) * std::min(std::max(t / T, 0.0), 1.0);
      case Course::start_stop:
        return fast * once(t / T);
      case Course::stop_and_go:
        return fast * once(std::fmod(t, 60.0) / 60.0);
      case Course::reversal:
        return fast - 2.0 * fast * eased((t - 0.4 * T) / (0.2 * T));
      case Course::wander: {
        double share = 0.0;
        for (std::size_t i = 0; i < phase_.size(); ++i)
          share += std::sin(2.0 * pi * t / period_s_[i] + phase_[i]) / 8.0;
        return slow * (1.0 + share);
      }
      case Course::pushes: {
        // Each push adds speed within a quarter of a second; rolling resistance reduces it again.
        double speed = 0.0;
        for (const Push& push : pushes_) {
          const double since = t - push.at_s;
          if (since > 0.0)
            speed += 0.45 * fast * push.size * eased(since / 0.25) * std::exp(-since / 2.0);
        }
        return speed * (1.0 - eased((t - (T - 3.0)) / 2.0));
      }
    }
    return 0.0;
  }

 private:
  /// From rest to full speed and back, by the share of the time.
  [[nodiscard]] static double once(double share) {
    return eased((share - 0.08) / 0.2) - eased((share - 0.7) / 0.2);
  }

  struct Push {
    double at_s, size;
  };
  const World& world_;
  std::array<double, 4> phase_{}, period_s_{};
  std::vector<Push> pushes_;
};

/// Speed of the wheel: the commanded one with a ripple depending on the angle.
class Motion {
 public:
  Motion(const World& world, std::uint64_t seed) : command_(world, seed), ripple_(world.ripple) {
    Random random(seed, "ripple");
    for (double& phase : phase_) phase = random.phase();
  }

  [[nodiscard]] double speed(double t, double angle) const {
    double share = 1.0;
    for (std::size_t i = 0; i < phase_.size(); ++i)
      share += ripple_ * std::sin(ripple_orders[i] * angle + phase_[i]);
    return command_.at(t) * share;
  }

  /// Runge–Kutta of fourth order.
  [[nodiscard]] double next(double t, double angle) const {
    const double h = step_s;
    const double a = speed(t, angle), b = speed(t + h / 2, angle + h / 2 * a);
    const double c = speed(t + h / 2, angle + h / 2 * b), d = speed(t + h, angle + h * c);
    return angle + h / 6 * (a + 2 * b + 2 * c + d);
  }

 private:
  Command command_;
  double ripple_;
  std::array<double, ripple_orders.size()> phase_{};
};

/// White noise through a resonance.
class Resonance {
 public:
  Resonance(double frequency_hz, double quality) {
    const double w = 2.0 * pi * frequency_hz * step_s;
    const double decay = std::exp(-w / (2.0 * quality));
    a1_ = 2.0 * decay * std::cos(w), a2_ = -decay * decay;
    // Variance of an AR(2) process driven by unit white noise.
    gain_ = std::sqrt((1.0 + a2_) * ((1.0 - a2_) * (1.0 - a2_) - a1_ * a1_) / (1.0 - a2_));
  }
  double operator()(double white) {
    const double now = a1_ * last_ + a2_ * before_ + gain_ * white;
    before_ = last_;
    last_ = now;
    return now;
  }

 private:
  double a1_, a2_, gain_, last_ = 0.0, before_ = 0.0;
};

/// Vibration of the hub with an rms of 1, along one direction.
class Road {
 public:
  Road(std::uint64_t seed, const char* direction) : random_(seed, direction) {}
  double operator()() {
    const double white = random_.normal();
    return 0.5 * body_(white) + 0.7 * axle_(random_.normal()) + 0.5 * tyre_(random_.normal());
  }

 private:
  Random random_;
  Resonance body_{1.5, 3.0}, axle_{12.0, 3.0}, tyre_{60.0, 4.0};
};

/// The plane of the wheel: first and second axis and axle, in inertial coordinates (z up).
struct Frame {
  Vec3 first{1.0, 0.0, 0.0}, second, axle;
  explicit Frame(double tilt_rad)
      : second{0.0, std::sin(tilt_rad), std::cos(tilt_rad)},
        axle{0.0, -std::cos(tilt_rad), std::sin(tilt_rad)} {}
  /// Position of a point at a radius and angle in the plane.
  [[nodiscard]] Vec3 point(double radius, double angle) const {
    Vec3 p{};
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = radius * (std::cos(angle) * first[i] + std::sin(angle) * second[i]);
    return p;
  }
};

/// A one-pole filter, stepped.
struct Pole {
  double share = 1.0;  ///< fraction of the input kept in a step
  double value = 0.0;
  void set(double pole_hz) {
    share = pole_hz > 0.0 ? 1.0 - std::exp(-2.0 * pi * pole_hz * step_s) : 1.0;
  }
  void take(double input, bool first) { value = first ? input : value + share * (input - value); }
};

/// Output of one unit along u, v and the axle, and of its gyroscope about the axle.
class Output {
 public:
  Output(const Unit& unit, const Frame& frame) : unit_(unit), frame_(frame) {
    for (Pole& pole : poles_) pole.set(unit.pole_hz);
  }

  void take(const std::array<double, 3>& angles, const Vec3& hub_mps2, bool first) {
    Vec3 force = hub_mps2;
    const double out = unit_.direction_rad;
    const Vec3 was = frame_.point(unit_.radius_m, angles[0] + out),
               now = frame_.point(unit_.radius_m, angles[1] + out),
               will = frame_.point(unit_.radius_m, angles[2] + out);
    for (std::size_t i = 0; i < 3; ++i)
      force[i] += (will[i] - 2.0 * now[i] + was[i]) / (step_s * step_s);
    force[2] += standard_gravity_mps2;
    const Vec3 u = frame_.point(1.0, angles[1] + unit_.mounting_rad),
               v = frame_.point(1.0, angles[1] + unit_.mounting_rad + pi / 2);
    poles_[0].take(dot(force, u), first);
    poles_[1].take(dot(force, v), first);
    poles_[2].take(dot(force, frame_.axle), first);
    poles_[3].take((angles[2] - angles[0]) / (2.0 * step_s), first);
  }

  [[nodiscard]] std::array<double, 4> values() const {
    return {poles_[0].value, poles_[1].value, poles_[2].value, poles_[3].value};
  }

 private:
  const Unit& unit_;
  const Frame& frame_;
  std::array<Pole, 4> poles_;
};

/// Rows of one unit, measured from its output.
class Rows {
 public:
  Rows(const Unit& unit, std::uint64_t seed, std::size_t index)
      : unit_(unit), noise_(seed, "noise", index), walk_(seed, "walk", index) {
    wander_.fill(0.0);
  }

  void add(double t,
           double stamp_s,
           const std::array<double, 4>& f,
           double since_s,
           estimate::WheelSensor& sensor) {
    for (double& wander : wander_)
      wander += unit_.walk_mps2_rts * std::sqrt(since_s) * walk_.normal();
    warm_ = unit_.warm_up_mps2 * (1.0 - std::exp(-t / 15.0));
    std::array<double, 3> read{unit_.scale[0] * (f[0] + unit_.skew_rad * f[1]),
                               unit_.scale[1] * (f[1] + unit_.skew_rad * f[0]), f[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      read[i] += unit_.bias_mps2[i] + wander_[i] + warm_ + unit_.noise_mps2 * noise_.normal();
      if (unit_.step_mps2 > 0.0) read[i] = unit_.step_mps2 * std::round(read[i] / unit_.step_mps2);
      sensor.accel_mps2[i].push_back(read[i]);
    }
    sensor.time_s.push_back(stamp_s);
    if (unit_.gyro)
      gyro_.push_back(unit_.gyro->scale * f[3] + unit_.gyro->bias_radps +
                      unit_.gyro->noise_radps * noise_.normal());
  }

  [[nodiscard]] std::array<double, 2> final_bias() const {
    return {unit_.bias_mps2[0] + wander_[0] + warm_, unit_.bias_mps2[1] + wander_[1] + warm_};
  }
  [[nodiscard]] const std::vector<double>& gyro() const { return gyro_; }

 private:
  const Unit& unit_;
  Random noise_, walk_;
  std::array<double, 3> wander_{};
  double warm_ = 0.0;
  std::vector<double> gyro_;
};

/// Angle that the head of an encoder sees at an angle of the axle.
double seen_by(const Encoder& encoder, double angle) {
  const double towards = angle + encoder.eccentricity_phase;
  const double about_centre = std::atan2(-encoder.eccentricity * std::sin(towards),
                                         1.0 - encoder.eccentricity * std::cos(towards));
  const double seen =
      angle - about_centre + encoder.warp_rad * std::cos(2.0 * angle + encoder.warp_phase);
  return encoder.reversed ? -seen : seen;
}

/// Fourier coefficients of the seen angle less the axle's, over the seen angle.
std::array<double, 4> errors_of(const Encoder& encoder) {
  constexpr int points = 3600;
  const double d = encoder.reversed ? -1.0 : 1.0;
  std::array<double, 4> sums{};
  double before = seen_by(encoder, -2.0 * pi / points);
  for (int i = 0; i < points; ++i) {
    const double angle = 2.0 * pi * i / points, seen = seen_by(encoder, angle);
    const double error = seen - d * angle,
                 width = 0.5 * std::abs(seen_by(encoder, angle + 2.0 * pi / points) - before);
    before = seen;
    for (std::size_t n = 1; n <= 2; ++n) {
      sums[2 * n - 2] += error * std::cos(static_cast<double>(n) * seen) * width / pi;
      sums[2 * n - 1] += error * std::sin(static_cast<double>(n) * seen) * width / pi;
    }
  }
  return sums;
}

/// Packet stamps: all rows of a packet have about the time of its arrival, delayed by the radio
/// link.
class Stamps {
 public:
  Stamps(const World& world, std::uint64_t seed) : world_(world), random_(seed, "stamps") {}
  double operator()(double t, bool exact) {
    const double step = 1.0 / world_.rate_hz;
    double stamp = t + world_.jitter * step * (exact ? 0.0 : random_.normal());
    if (world_.stamps_by_wifi && !exact) {
      if (left_ == 0) {
        left_ = 1 + static_cast<int>(6.0 * random_.unit());
        arrival_s_ = t + static_cast<double>(left_) * step * (0.2 + 0.8 * random_.unit());
      }
      --left_;
      arrival_s_ += 1e-5;
      stamp = arrival_s_;
    }
    last_s_ = std::max(stamp, last_s_ + 1e-6);
    return last_s_;
  }

 private:
  const World& world_;
  Random random_;
  int left_ = 0;
  double arrival_s_ = 0.0, last_s_ = -1.0;
};

}  // namespace

Recorded record(const World& world, std::uint64_t seed) {
  Recorded out;
  const Motion motion(world, seed);
  const Frame frame(world.axle_tilt_rad);
  std::vector<Output> outputs;
  std::vector<Rows> rows;
  for (std::size_t i = 0; i < world.units.size(); ++i) {
    outputs.emplace_back(world.units[i], frame);
    rows.emplace_back(world.units[i], seed, i);
    out.sensors.emplace_back();
    out.sensors.back().name = i == 0 ? "one" : "two";
  }
  Road along(seed, "along"), up(seed, "up");
  Random missing(seed, "missing");
  Stamps stamp(world, seed);
  const auto last_row = static_cast<std::size_t>(std::floor(world.duration_s * world.rate_hz));
  std::size_t row = 0;
  double t = -lead_s, last_t = 0.0;
  std::vector<double> seen_rad;
  const double count_rad = world.encoder ? 2.0 * pi / world.encoder->counts_per_turn : 0.0;
  // The angle one step before, now, and one step after.
  std::array<double, 3> angle{};
  angle[1] = world.start_angle_rad;
  angle[0] = angle[1] - step_s * motion.speed(t, angle[1]);
  angle[2] = motion.next(t, angle[1]);
  std::vector<std::array<double, 4>> before(world.units.size());
  double first_angle = 0.0;
  for (bool first = true; row <= last_row; first = false) {
    Vec3 hub{};
    if (world.road_mps2 > 0.0) {
      const double moving = std::min(1.0, std::abs(motion.speed(t, angle[1])) / 3.0);
      hub[0] = world.road_mps2 * moving * 0.5 * along();
      hub[2] = world.road_mps2 * moving * up();
    }
    hub[0] -= world.rolling_radius_m * (angle[2] - 2.0 * angle[1] + angle[0]) / (step_s * step_s);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      before[i] = outputs[i].values();
      outputs[i].take(angle, hub, first);
    }
    // Rows between the previous step and this one.
    while (row <= last_row && static_cast<double>(row) / world.rate_hz <= t) {
      const double at = static_cast<double>(row) / world.rate_hz;
      const double share = 1.0 - (t - at) / step_s;
      const double angle_then = angle[1] - (t - at) * motion.speed(t, angle[1]);
      const bool end = row == 0 || row == last_row;
      if (row == 0) first_angle = angle_then;
      if (row == last_row) {
        out.truth.turns = (angle_then - first_angle) / (2.0 * pi);
        out.truth.final_angle_rad = angle_then + world.units.front().mounting_rad;
      }
      out.truth.time_s.push_back(at);
      out.truth.angle_rad.push_back(angle_then + world.units.front().mounting_rad);
      ++row;
      if (!end && missing.unit() < world.missing) continue;
      const double stamp_s = stamp(at, end);
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        std::array<double, 4> f{};
        for (std::size_t c = 0; c < 4; ++c)
          f[c] = before[i][c] + share * (outputs[i].values()[c] - before[i][c]);
        rows[i].add(at, stamp_s, f, at - last_t, out.sensors[i]);
      }
      if (world.encoder)
        seen_rad.push_back(count_rad * std::floor(seen_by(*world.encoder, angle_then) / count_rad));
      last_t = at;
    }
    t += step_s;
    angle = {angle[1], angle[2], motion.next(t, angle[2])};
  }
  out.truth.units = world.units;
  out.truth.rolling_radius_m = world.rolling_radius_m;
  if (world.encoder) {
    out.encoder = estimate::WheelEncoder{
        "encoder", signal::fixes_of_samples(out.sensors[0].time_s, seen_rad, count_rad, 0.0),
        count_rad};
    out.truth.encoder_errors_rad = errors_of(*world.encoder);
  }
  // Only about the axle: the other two axes of a gyroscope on a wheel measure almost nothing.
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].gyro().empty()) continue;
    out.sensors[i].rate_radps[2] = rows[i].gyro();
    for (const std::size_t axis : {0U, 1U})
      out.sensors[i].rate_radps[axis].assign(rows[i].gyro().size(), 0.0);
  }
  for (const Rows& of_unit : rows) out.truth.final_bias_mps2.push_back(of_unit.final_bias());
  return out;
}

}  // namespace proofmass::wheel_world
