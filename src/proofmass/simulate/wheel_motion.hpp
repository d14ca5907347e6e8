#pragma once

#include <cstdint>
#include <vector>

namespace proofmass::simulate {

/// A segment of the wheel's speed: linear from the previous speed to speed_radps within ramp_s,
/// then constant to the end. ramp_s = 0 is a step, whose impulse of acceleration is between
/// samples; speed 0 is a rest, a change of sign a reversal. The first segment starts at rest if it
/// has a ramp, at its own speed if not.
struct SpeedSegment {
  double duration_s = 0.0;
  double speed_radps = 0.0;
  double ramp_s = 0.0;
};

/// Ripple of the actual speed about the commanded one ω0, whose integral is Φ: ω = ω0 (1 + Σ a_i
/// sin(n_i Φ + φ_i)), phases by the seed. As a function of Φ it integrates in closed form, vanishes
/// with the speed and repeats with the turns like that of a motor or gear.
struct SpeedRipple {
  double fraction = 0.0;             ///< amplitude of one sine at `order`
  double order = 1.0;                ///< n, cycles per revolution
  double random_fraction_rms = 0.0;  ///< noise with a flat spectrum of orders
  double random_max_order = 10.0;    ///< upper limit of the orders, from 0
};

struct WheelState {
  double angle_rad = 0.0, speed_radps = 0.0, accel_radps2 = 0.0;
};

/// The wheel's motion, exact at any time: no numerical integration. After its profile it keeps the
/// last speed.
class WheelMotion {
 public:
  WheelMotion(double start_angle_rad,
              const std::vector<SpeedSegment>& profile,
              const SpeedRipple& ripple,
              std::uint64_t seed);
  [[nodiscard]] WheelState at(double t_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  struct Piece {
    double start_s, angle_rad, speed_radps, accel_radps2;
  };
  struct Sine {
    double order, amplitude, phase_rad;
  };

  double start_angle_rad_;
  double duration_s_ = 0.0;
  std::vector<Piece> pieces_;
  std::vector<Sine> ripple_;
};

}  // namespace proofmass::simulate
