#include "proofmass/servo/loop/observer.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "proofmass/servo/motor_model_test_support.hpp"
#include "proofmass/simulate/gear_motor.hpp"

namespace proofmass::servo {
namespace {

// Forwards, backwards through the gap of the gear, forwards: angle and speed are those of the load,
// also while the gap is crossed, and the biases do not matter after a turn.
TEST(MotorObserver, FollowsTheLoadThroughReversals) {
  constexpr double step_s = 0.005, noise = 0.013, bias = 0.1;
  const simulate::GearMotorParameters drive;
  simulate::GearMotor motor(drive);
  MotorObserver observer({.model = model_of(drive),
                          .step_s = step_s,
                          .accel_std_mps2 = noise,
                          .bias_std_mps2 = bias,
                          .current_std_a = 0.002},
                         0.0);
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  int outside = 0, counted = 0;
  double largest_speed_error = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * step_s;
    const double voltage = t < 12.0 ? 30.0 : t < 18.0 ? -25.0 : 20.0;
    motor.advance(voltage, step_s);
    observer.predict(voltage);
    const double angle = motor.state().load_rad, g = standard_gravity_mps2;
    observer.update({.current_a = motor.state().current_a + 0.002 * normal(engine),
                     .accel_mps2 = {g * std::sin(angle) + bias + noise * normal(engine),
                                    g * std::cos(angle) - bias + noise * normal(engine)}});
    if (t < 8.0) continue;
    ++counted;
    const Uncertain found = observer.load_rad();
    if (std::abs(found.value - angle) > 3.0 * found.std) ++outside;
    const bool crossing = (t > 11.9 && t < 12.6) || (t > 17.9 && t < 18.6);
    if (!crossing)
      largest_speed_error = std::max(
          largest_speed_error, std::abs(observer.speed_radps().value - motor.state().load_radps));
  }
  EXPECT_LT(outside, counted / 50);
  EXPECT_LT(largest_speed_error, 0.01);
}

}  // namespace
}  // namespace proofmass::servo
