#pragma once

#include <array>
#include <cstddef>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/servo/motor_model.hpp"

namespace proofmass::servo {

struct MotorObserverOptions {
  MotorModel model;
  double step_s = 0.005;
  double gravity_mps2 = standard_gravity_mps2;
  double accel_std_mps2 = 0.0184;  ///< noise of the mean of the sensors, one axis
  double bias_std_mps2 = 0.3;      ///< of that mean, unknown at the start
  double current_std_a = 0.002;
  double torque_noise = 0.1;      ///< √density of what the model does not know, N m/√Hz
  double load_torque_walk = 0.3;  ///< of the load's torque, N m/√s
};

/// Measurements of one sample.
struct MotorSample {
  double current_a = 0.0;
  /// Mean over opposite sensors with parallel axes: g (sin θ, cos θ) and biases.
  std::array<double, 2> accel_mps2{};
};

/// Extended Kalman filter with the states motor angle, speed, current, load torque, play (motor
/// minus load angle) and two biases. The play follows the motor while the gap is open and stays at
/// its end: a smooth dead zone,
///
///     β' = ω (1 − (β/δ)² where β points along ω),
///
/// after R. Bouc's hysteresis model, with the load held by its friction. It is not held exactly,
/// and overruns a motor that brakes: β is uncertain by its range while the gap is crossed, with the
/// process noise δ |ω| while it is open or may be.
/// Source: docs/methods/servo.md.
class MotorObserver {
 public:
  MotorObserver(const MotorObserverOptions& options, double load_rad);

  /// The step to the next sample at a constant voltage.
  void predict(double voltage_v);
  void update(const MotorSample& sample);

  [[nodiscard]] Uncertain load_rad() const;
  [[nodiscard]] Uncertain speed_radps() const;
  [[nodiscard]] double current_a() const { return x_[2]; }
  [[nodiscard]] double load_torque_nm() const { return x_[3]; }

 private:
  static constexpr std::size_t states = 7;
  using Row = std::array<double, states>;

  void measure(const Row& H, double innovation, double variance);

  MotorObserverOptions options_;
  Row x_{};
  std::array<Row, states> P_{};
};

}  // namespace proofmass::servo
