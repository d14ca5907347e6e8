#pragma once

#include "proofmass/estimate/tilt_model.hpp"

// What the base does besides turning, by its scatter. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

/// The base's acceleration as scatter of the force.
struct BaseAccel {
  std::vector<double> std_mps2;   ///< each component, at every instant, over the past M
  double time_s = 0.0;            ///< lag at which its autocorrelation falls to 1/e, 1 s at most
  double reading_std_mps2 = 0.0;  ///< white part, by the scatter of neighbours
};

/// With gyroscope, less its bias as far as it is known, the departure of f from its running mean,
/// which turns with the sensor:
///
///     m' = exp(−[ω Δ]×) m + (1 − e^(−Δ/2 s)) (f − m),   σ² = max(⟨|f − m|²⟩/3, ⟨(|f| − G)²⟩),
///
/// over M = 60 correlation times, 2 to 20 s, less what the mean takes of slow departures; and
/// without it (|f| − G)² alone, which sees the acceleration along gravity: a base that only speeds
/// up on the level cannot then be told from one that tilts. A rule, not a likelihood: one step
/// ahead a smooth acceleration looks like a slow one, and a likelihood would make it so slow that
/// gravity drowned in it.
[[nodiscard]] BaseAccel base_accel(const TiltInstants& instants,
                                   const Mat<3>& rate_bias,
                                   double gravity_mps2);

}  // namespace proofmass::estimate
