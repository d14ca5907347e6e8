#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace proofmass::estimate::motor {

/// A drive's measurements at a constant rate.
struct Series {
  double step_s = 0.0;
  std::vector<double> voltage_v;
  std::vector<double> current_a;            ///< smoothed() over 50 ms; empty: not measured
  std::vector<double> sampled_current_a{};  ///< the same, not smoothed
  double current_offset_a = 0.0;            ///< subtracted from both
  std::vector<double> angle_rad;            ///< of the load, unwrapped, positive with the voltage
  /// Whether a sample is interpolated over a gap of the recording, of unknown motion.
  std::vector<bool> bridged;
  bool from_gravity = false;  ///< the angle comes from accelerometers
  double gravity_mps2 = 0.0;

  [[nodiscard]] std::size_t size() const { return angle_rad.size(); }
  [[nodiscard]] bool has_current() const { return !current_a.empty(); }
  [[nodiscard]] double time_s(std::size_t k) const { return static_cast<double>(k) * step_s; }
};

/// Speed of the drive, where it moves, and on which flank the gear bears.
struct Motion {
  std::vector<double> speed_radps;
  /// The load's, for what depends on the position. Once there is a fit it is the model's angle:
  /// functions of the measured one contain its noise, which the coefficients would cancel, and the
  /// torque constant would come out too large.
  std::vector<double> angle_rad;
  double rest_radps = 0.0;             ///< least speed at which friction is known
  std::vector<std::int8_t> contact{};  ///< +1, −1: flank that bears; 0: at rest, or not certain
  std::size_t half_window = 0;  ///< samples on either side from which the speed is determined

  [[nodiscard]] bool has_both_flanks() const;
  /// Reversals of the load.
  [[nodiscard]] std::size_t reversals() const;
  /// Speed that 1 % of the samples exceed.
  [[nodiscard]] double top_radps() const;
};

[[nodiscard]] double largest_magnitude(const std::vector<double>& values);

/// Standard deviation of the white noise of one sample, from the third differences, which are small
/// for a smooth motion.
[[nodiscard]] double sample_noise(const std::vector<double>& values);

/// Derivative of a series by the local cubic through ± half samples (A. Savitzky, M. J. E. Golay,
/// Analytical Chemistry 36 (1964) 1627); fewer at the ends. Its standard deviation is
/// slope_noise(half) · σ / step_s for white noise σ.
[[nodiscard]] std::vector<double> slopes(const std::vector<double>& y,
                                         double step_s,
                                         std::size_t half);
[[nodiscard]] double slope_noise(std::size_t half);

/// Integral by the trapezoidal rule, 0 at the first sample.
[[nodiscard]] std::vector<double> integral(const std::vector<double>& y, double step_s);

/// Value of the local cubic over a window: the slope of the integral.
[[nodiscard]] std::vector<double> smoothed(const std::vector<double>& y,
                                           double step_s,
                                           double window_s);
/// Samples on either side in a window.
[[nodiscard]] std::size_t half_window(double window_s, double step_s);

/// Sets `margin` samples at both ends of each run of one flank to 0. Where a threshold of the speed
/// begins or ends a run, the noise of the samples near it is no longer of mean zero, which made the
/// angle travelled 0.1 % too small.
void shorten_runs(std::vector<std::int8_t>& contact, std::size_t margin);

/// Motion from the load's angle alone.
[[nodiscard]] Motion motion_of_load(const Series& series);

/// Subtracts what the current's channel shows where the load rests and there is no voltage, if it
/// does for half a second in all.
void subtract_current_offset(const Motion& load, Series& series);

/// The motor's speed, by its back-EMF.
struct MotorSpeed {
  std::vector<double> radps;
  double std_radps = 0.0;
  std::size_t half_window = 0;
};

/// Motion of the motor, `load_rad` the load's angle. The gear bears on a flank from settle_s after
/// the motor has crossed the gap until the motor is at rest: the play operator of angle and gap (M.
/// A. Krasnosel'skii, A. V. Pokrovskii, Systems with Hysteresis (1989), section 1.2), where the
/// load's own friction keeps it on the flank that drives it. While the motor brakes, its current
/// against the motion, the load may lie anywhere in the gap; it bears again where the operators
/// from both flanks agree. Samples near a step of the voltage do not count.
[[nodiscard]] Motion motion_of_motor(const Series& series,
                                     const std::vector<double>& motor_rad,
                                     std::vector<double> load_rad,
                                     MotorSpeed speed,
                                     double gap_rad);

}  // namespace proofmass::estimate::motor
