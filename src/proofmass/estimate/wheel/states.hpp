#pragma once

namespace proofmass::estimate {

/// Indices of each quantity in the state; those of a sensor are relative to first_of(sensor).
namespace wheel {
inline constexpr int angle = 0, speed = 1, accel = 2, jerk = 3, moving = 4;
/// The angle at the first epoch is kept as a constant state, so that one covariance gives the
/// variance of the turns since then.
inline constexpr int start = 4;
inline constexpr int bias = 0, scale = 2, skew = 4;  ///< of a sensor, relative to first_of

[[nodiscard]] constexpr int first_of(int sensor) {
  return 5 + 5 * sensor;
}
/// Phase of the second sensor against the first.
inline constexpr int phase = first_of(2);
inline constexpr int ripple_orders = 4;  ///< (c, s) for each
[[nodiscard]] constexpr int ripple(int sensors) {
  return first_of(sensors) + (sensors - 1);
}
/// Bias, rad/s, and scale error of each sensor's gyroscope, and the tangent of the axle's
/// inclination.
inline constexpr int gyro_bias = 0, gyro_scale = 1, gyro_tilt = 2, gyro_states = 3;
[[nodiscard]] constexpr int gyro(int sensors) {
  return ripple(sensors) + 2 * ripple_orders;
}
/// Rolling radius, m, the difference from the model's; estimated with a gyroscope.
[[nodiscard]] constexpr int rolling(int sensors) {
  return gyro(sensors) + gyro_states * sensors;
}
/// Offset of the encoder, rad, then (c, s) of each order of its errors.
inline constexpr int encoder_orders = 2, encoder_states = 1 + 2 * encoder_orders;
[[nodiscard]] constexpr int encoder(int sensors) {
  return rolling(sensors) + 1;
}
/// The lever arms come last: once found they are held, and the filter runs on the states before
/// them.
[[nodiscard]] constexpr int places(int sensors) {
  return encoder(sensors) + encoder_states;
}
[[nodiscard]] constexpr int states(int sensors) {
  return places(sensors) + 2 * sensors;
}
/// Static states from first_of(0) on: the sensors' constants, the phase, the lever arms.
[[nodiscard]] constexpr int standing(int sensors) {
  return states(sensors) - first_of(0);
}
}  // namespace wheel

}  // namespace proofmass::estimate
