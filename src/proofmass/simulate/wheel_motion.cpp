#include "proofmass/simulate/wheel_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/simulate/band_limited_noise.hpp"

namespace proofmass::simulate {

WheelMotion::WheelMotion(double start_angle_rad,
                         const std::vector<SpeedSegment>& profile,
                         const SpeedRipple& ripple,
                         std::uint64_t seed)
    : start_angle_rad_(start_angle_rad) {
  PM_EXPECTS(!profile.empty());
  double speed_radps = profile.front().ramp_s > 0.0 ? 0.0 : profile.front().speed_radps;
  double angle_rad = 0.0;
  const auto append = [&](double duration_s, double end_speed_radps) {
    if (duration_s <= 0.0) return;
    const double accel_radps2 = (end_speed_radps - speed_radps) / duration_s;
    pieces_.push_back({duration_s_, angle_rad, speed_radps, accel_radps2});
    angle_rad += 0.5 * (speed_radps + end_speed_radps) * duration_s;
    duration_s_ += duration_s;
    speed_radps = end_speed_radps;
  };
  for (const SpeedSegment& segment : profile) {
    append(segment.ramp_s, segment.speed_radps);
    speed_radps = segment.speed_radps;
    append(segment.duration_s - segment.ramp_s, segment.speed_radps);
  }
  PM_EXPECTS(!pieces_.empty());
  if (pieces_.back().accel_radps2 != 0.0)
    pieces_.push_back({duration_s_, angle_rad, speed_radps, 0.0});

  Random random(seed, "speed ripple");
  if (ripple.fraction > 0.0) ripple_.push_back({ripple.order, ripple.fraction, random.phase()});
  // The noise's "frequency" is in cycles per revolution, its "time" Φ in revolutions.
  const BandLimitedNoise noise(ripple.random_fraction_rms, ripple.random_max_order,
                               Random(seed, "random speed ripple"));
  for (const auto& c : noise.components())
    ripple_.push_back(
        {c.frequency_radps / (2.0 * std::numbers::pi), noise.amplitude(), c.phase_rad});
}

WheelState WheelMotion::at(double t_s) const {
  const auto after = std::ranges::upper_bound(pieces_, t_s, {}, &Piece::start_s);
  const Piece& piece = after == pieces_.begin() ? pieces_.front() : *(after - 1);
  const double dt = t_s - piece.start_s;
  const double speed = piece.speed_radps + piece.accel_radps2 * dt;  // ω0
  const double phi = piece.angle_rad + piece.speed_radps * dt + 0.5 * piece.accel_radps2 * dt * dt;

  // θ = Φ + Σ (a/n)(cos φ − cos(nΦ + φ)), and its first two time derivatives.
  double angle = start_angle_rad_ + phi, rate = 1.0, bend = 0.0;
  for (const Sine& s : ripple_) {
    const double argument = s.order * phi + s.phase_rad;
    const double sine = std::sin(argument), cosine = std::cos(argument);
    angle += s.amplitude / s.order * (std::cos(s.phase_rad) - cosine);
    rate += s.amplitude * sine;
    bend += s.amplitude * s.order * cosine;
  }
  return {angle, speed * rate, piece.accel_radps2 * rate + speed * speed * bend};
}

}  // namespace proofmass::simulate
