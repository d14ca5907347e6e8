#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace proofmass::estimate::motor {

/// A drive's measurements at a constant rate.
struct Series {
  double step_s = 0.0;
  std::vector<double> voltage_v;
  std::vector<double> current_a;  ///< empty: not measured
  std::vector<double> angle_rad;  ///< of the load, unwrapped, positive with the voltage
  bool from_gravity = false;      ///< the angle comes from accelerometers
  double gravity_mps2 = 0.0;

  [[nodiscard]] std::size_t size() const { return angle_rad.size(); }
  [[nodiscard]] bool has_current() const { return !current_a.empty(); }
};

/// What the model takes as known while its parameters are estimated: the speed at which friction
/// is evaluated, whether the drive is at rest, and on which flank the gear bears. With these fixed
/// the model is linear in its states.
struct Regimes {
  /// Smooth angle: what depends on the position is evaluated there, not at the measured one, whose
  /// noise the coefficients would otherwise cancel.
  std::vector<double> angle_rad;
  std::vector<double> speed_radps, accel_radps2;
  double speed_std_radps = 0.0;
  double rest_radps = 0.0;          ///< below this speed of the load friction is unknown
  double dry_torque = 0.0;          ///< size of the dry friction that is then unknown
  std::vector<std::uint8_t> rests;  ///< 1: the load is at rest in the step from k to k + 1, or nearly
  std::vector<std::int8_t> contact;        ///< +1, −1: flank; 0: not certain
  std::vector<double> current_sign;        ///< smooth sign of the current
};

/// Standard deviation of the noise of one sample, from the third differences: of a smooth motion
/// they are small.
[[nodiscard]] double sample_noise(const std::vector<double>& values);

/// Speed by a local parabola through the angles, rests by its size, and the flank as the load's
/// direction requires if friction holds it.
[[nodiscard]] Regimes first_regimes(const Series& series);

/// The regimes at another estimate of the motion; contact is kept. Rests are widened by `margin`
/// samples on either side: the onset of motion lies between samples, or is smeared by a smoother.
void set_motion(const Series& series,
                std::vector<double> angle_rad,
                std::vector<double> speed_radps,
                std::size_t margin,
                Regimes& regimes);

/// The flank by the direction of motion, 0 at rest and for `margin_s` after each rest.
void contact_by_direction(const Series& series, double margin_s, Regimes& regimes);

}  // namespace proofmass::estimate::motor
