#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

// Friction, inertia and backlash of a geared DC motor from its voltage, its current and the angle
// of its load.
namespace proofmass::estimate {

/// Measurements of a drive at common times.
struct MotorRecord {
  std::vector<double> time_s;
  std::vector<double> voltage_v;
  std::vector<double> current_a;  ///< empty: not measured
  /// Accelerometers on the wheel, m/s²: x, y and z, an axis that is missing empty. Not used if
  /// there is an angle.
  std::vector<std::array<std::vector<double>, 3>> accel_mps2;
  std::vector<double> angle_rad;  ///< of the load: an encoder's, unwrapped; empty: none
};

struct MotorOptions {
  double gravity_mps2 = 9.80665;
  double most_rate_hz = 200.0;  ///< faster samples are averaged down to this
  Progress progress{};
};

/// One figure of the drive, in coordinates of the load's shaft.
struct MotorParameter {
  std::string name, unit;
  std::string meaning;
  std::optional<Uncertain> value{};
  std::optional<std::array<double, 2>> interval_95{};
  std::string reason{};  ///< why there is no value
};

/// Friction torque against speed, forwards.
struct FrictionPoint {
  double speed_radps = 0.0, torque = 0.0, std = 0.0;
};

struct MotorSeries {
  std::vector<double> time_s{}, voltage_v{}, current_a{};
  std::vector<double> load_angle_rad{};   ///< as measured
  std::vector<double> motor_angle_rad{};  ///< at the load's shaft; empty without a current
  std::vector<double> speed_radps;        ///< of the motor; of the load without a current
  std::vector<double> friction{};  ///< at that speed, in the unit of the curve; NaN without contact
  std::vector<std::int8_t> contact;  ///< −1, +1: flank that bears; 0: at rest, or not certain
};

struct MotorSolution {
  std::vector<MotorParameter> parameters{};
  std::vector<FrictionPoint> friction{};  ///< N m, without a current V; over the speeds recorded
  bool has_current = false;
  double rate_hz = 0.0;          ///< at which it was analysed
  double angle_noise_rad = 0.0;  ///< standard deviation of one sample of the angle
  double moving_share = 0.0;     ///< share of the samples in motion on a certain flank
  std::size_t reversals = 0;
  /// Correlation of each normalised innovation with the next, of the winding's equation and of that
  /// of motion: 0 if the noise is as modelled.
  std::optional<double> angle_correlation{};
  double motion_correlation = 0.0;
  MotorSeries series{};
  std::vector<Note> notes;

  /// nullptr if there is no parameter of that name.
  [[nodiscard]] const MotorParameter* find(std::string_view name) const;
};

/// Identifies the drive by two linear regressions whose noise is white plus a random walk:
///
///     θ = (1/K) ∫ (u − R i − Vb tanh(i/s) − u0) dt − (L/K) i ∓ δ + errors of the angle,
///     J ω' = K i − b ω − (Tc + Fs exp(−(ω/ωs)²)) sgn ω − U cos(θ + φ) − T0, integrated once,
///
/// with ω from the back-EMF. Only s and ωs are not linear: the likelihood is maximised over them.
/// What noise of the current does to the figures is found by repetition with more of it.
///
/// - At rest, and in the gap of the gear, friction is unknown: those samples are not used. The
///   motor's angle is known through the gap, by which the backlash 2δ shows.
/// - Without a current only ratios are identifiable: gain, time constant and the voltage that
///   friction costs.
///
/// Source: docs/methods/motor.md. Errors: invalid_argument (columns of unequal length, no rate),
/// too_few_samples, not_observable (no motion; accelerometers in whose axes gravity does not turn).
[[nodiscard]] Result<MotorSolution> estimate_motor(const MotorRecord& record,
                                                   const MotorOptions& options = {});

}  // namespace proofmass::estimate
