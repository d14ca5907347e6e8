#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/simulate/gear_motor.hpp"
#include "proofmass/simulate/rig.hpp"

// The rig with its motor: the voltage is given, the wheel's motion follows.
namespace proofmass::simulate {

struct MotorOptions {
  std::uint64_t seed = 1;
  double rate_hz = 200.0;
  double duration_s = 40.0;
  double gravity_mps2 = standard_gravity_mps2;
  GearMotorParameters drive;
  /// Two opposite sensors on the wheel, with a spread of ± this on their biases.
  std::vector<RigSensor> sensors{RigSensor{}, RigSensor{.position_rad = rad_per_turn / 2}};
  double bias_spread_mps2 = 0.3;
  double start_angle_rad = 0.4;
  double supply_limit_v = 90.0;  ///< of the controller's output
  double voltage_noise_v = 0.02, current_noise_a = 0.002;
  int adc_bits = 14;      ///< of voltage (± 100 V) and current (± 4 A); 0: none
  int encoder_lines = 0;  ///< of an encoder on the load, four counts each; 0: none
};

/// A test that identifies the drive: reversals at several speeds, slow and fast. V.
[[nodiscard]] double exploring_voltage(double t_s);

/// The drive with its sensors, a sample at a time.
class MotorRig {
 public:
  /// Errors: invalid_argument (the message names the option).
  [[nodiscard]] static Result<MotorRig> start(const MotorOptions& options);
  MotorRig(MotorRig&&) noexcept;
  MotorRig& operator=(MotorRig&&) noexcept;
  ~MotorRig();

  /// voltage (V), current (A), encoder (rad) if there is one, and acc1_x, acc1_y, acc2_x, … (m/s²).
  [[nodiscard]] const std::vector<Channel>& channels() const;
  /// Measurements now, in the order of the channels; draws their noise.
  void measure(std::vector<double>& row);
  /// Applies a voltage, limited by the supply, for one sample period.
  void advance(double voltage_v);
  /// The same for a part of it.
  void advance(double voltage_v, double duration_s);
  [[nodiscard]] const GearMotorState& state() const;
  /// Angle of the first sensor's x axis above the horizontal.
  [[nodiscard]] double angle_rad() const;

 private:
  class Parts;
  explicit MotorRig(const MotorOptions& options);
  std::unique_ptr<Parts> parts_;
};

struct MotorResult {
  Recording recording;
  /// angle (of the first sensor's x axis above the horizontal), speed and acceleration of the load,
  /// motor_angle and motor_speed, contact (−1, 0, 1), friction (N m).
  Recording truth;
};

/// The drive under the exploring voltage. Errors: as MotorRig::start().
[[nodiscard]] Result<MotorResult> simulate_motor(const MotorOptions& options);

}  // namespace proofmass::simulate
