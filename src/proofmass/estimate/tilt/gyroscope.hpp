#pragma once

namespace proofmass::estimate {

/// Variance in rad² of the angle over a step Δ due to a gyroscope's relative error s (scale,
/// cross-axis, lag), treated as white: s² ω² Δ T, with rotations in one direction that last T = 0.5
/// s.
[[nodiscard]] inline double turn_variance_rad2(double scale_std,
                                               double rate2_rad2ps2,
                                               double step_s) {
  constexpr double turn_s = 0.5;
  return scale_std * scale_std * rate2_rad2ps2 * step_s * turn_s;
}

/// How long a base keeps rotating in one direction, in s, if the rate is unknown.
inline constexpr double unknown_turn_s = 0.5;

}  // namespace proofmass::estimate
