#pragma once

namespace proofmass::estimate {

/// Variance in rad² that a gyroscope's relative error s (scale, cross-axis, lag) adds to the angle
/// over a step Δ, as if it were white: s² ω² Δ T, with turns that last T = 0.5 s one way.
[[nodiscard]] inline double turn_variance_rad2(double scale_std,
                                               double rate2_rad2ps2,
                                               double step_s) {
  constexpr double turn_s = 0.5;
  return scale_std * scale_std * rate2_rad2ps2 * step_s * turn_s;
}

/// How long a base goes on turning one way, in s, where nothing says how fast.
inline constexpr double unknown_turn_s = 0.5;

}  // namespace proofmass::estimate
