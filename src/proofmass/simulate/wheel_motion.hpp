#pragma once

#include <cstdint>
#include <vector>

namespace proofmass::simulate {

/// A stretch of the wheel's speed: from the speed before to speed_radps, linearly within ramp_s,
/// then that speed to the end. ramp_s = 0 is a step, whose impulse of acceleration no sample sees;
/// speed 0 is a rest, a change of sign a reversal. The first stretch starts at rest if it has a
/// ramp, at its own speed if not.
struct SpeedSegment {
  double duration_s = 0.0;
  double speed_radps = 0.0;
  double ramp_s = 0.0;
};

/// What the speed really does about the commanded one ω0, whose integral is Φ:
/// ω = ω0 (1 + Σ a_i sin(n_i Φ + φ_i)), phases by the seed. In terms of Φ it integrates in closed
/// form, dies with the speed and repeats with the turns as that of a motor or gear does.
struct SpeedRipple {
  double fraction = 0.0;             ///< of one sine at `order`, at its crest
  double order = 1.0;                ///< n, cycles per revolution
  double random_fraction_rms = 0.0;  ///< of noise with an even spectrum of orders
  double random_max_order = 10.0;    ///< from 0 to this
};

struct WheelState {
  double angle_rad = 0.0, speed_radps = 0.0, accel_radps2 = 0.0;
};

/// The wheel's motion, exact at any time: no step is integrated. Behind its profile it keeps the
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
