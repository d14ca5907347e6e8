#pragma once

#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// The thesis's method from accelerations to a path: double integration, its filter and its
// smoother.
namespace proofmass::thesis {

/// Measurements along one axis, or several fused into one signal, treated as the acceleration of a
/// path.
struct FusedReading {
  std::vector<double> time_s;
  std::vector<double> accel_mps2;  ///< NaN where missing
  double variance_m2ps4 = 1.0;     ///< variance of one measurement
  Uncertain bias_mps2 = {};        ///< at the first sample, prior
  double bias_rise_mps2 = 0.0;     ///< remaining change by the warm-up
  double time_constant_s = 70.0;   ///< time constant of that
  Uncertain start_speed_mps = {};  ///< of the path
};

/// The path from its start, one entry a sample.
struct ThesisPaths {
  std::vector<double> integrated_m;  ///< raw measurements, integrated twice
  std::vector<double> filtered_m, filtered_std_m;
  std::vector<double> smoothed_m, smoothed_std_m;
  std::vector<double> filtered_accel_mps2, smoothed_accel_mps2;
  std::vector<double> gain;  ///< of the acceleration: what of an innovation goes into it
};

/// Section 4.3 with its errors corrected (docs/errata.md): states p, v, a and the bias ε,
///
///     ε[k] = φ ε[k−1] + (1 − φ)(a1 + a2),  φ = e^(−Δ/T),  z = a + ε + v,  H = [0 0 1 1],
///
/// white jerk of density W = 1, P0 = 100 for the acceleration; the start position is known, the
/// start speed and bias have the uncertainty of `reading`. Rauch–Tung–Striebel smoother. Errors:
/// invalid_argument, not_finite, with the sample.
[[nodiscard]] Result<ThesisPaths> thesis_paths(const FusedReading& reading);

/// Double integral from an initial speed, linear between samples; missing measurements are
/// interpolated.
[[nodiscard]] std::vector<double> integrated_twice(View<double> time_s,
                                                   View<double> accel,
                                                   double start_speed);

/// What gravity, felt along an axis that starts at φ from the vertical and turns evenly, becomes
/// when it is integrated twice from rest:
///
///     ∫∫ g cos(ωt + φ) = (g/ω²) (cos φ − cos(ωt + φ) − ωt sin φ).
struct TurningGravity {
  double gravity_mps2 = 0.0, speed_radps = 1.0, phase_rad = 0.0;
};
[[nodiscard]] double gravity_path_m(const TurningGravity& gravity, double t_s);

}  // namespace proofmass::thesis
