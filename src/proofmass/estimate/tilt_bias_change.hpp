#pragma once

#include <vector>

#include "proofmass/estimate/tilt_rest.hpp"

// Whether a sensor has changed since its calibration. Private to the module's tilt*.cpp.
namespace proofmass::estimate {

struct BiasChange {
  double probability = 0.0;  ///< that the biases have changed
  double std_mps2 = 0.0;     ///< what each axis's bias is uncertain by beyond the calibration
};

/// By the norms of the force at rest, n_i = |f_i| − G, with unit vectors u_i along f_i:
///
///     n ~ N(0, U C Uᵀ + diag(noise) + σ_G² 1 1ᵀ + b² U Uᵀ),
///
/// C being the covariance of the calibration and b the standard deviation of the change of each
/// axis's bias. Before the readings b = 0 with probability 1/2, otherwise ln b is normal about 3 mg
/// with a standard deviation of 1.2: 0.3 to 30 mg, from the turn-on repeatability of a good MEMS
/// accelerometer to the drift of a poor one over 20 °C. `std_mps2` is such that ± 1.96 of it, with
/// C, is the 95 % interval of the mixture: the norm shows only the part along gravity, the tilt is
/// wrong by the parts across it. At most 16 rests are compared, spread over the recording. Expects
/// three axes at each.
[[nodiscard]] BiasChange bias_change(const std::vector<TiltRest>& rests,
                                     const ForceSpread& spread,
                                     const Uncertain& gravity_mps2);

}  // namespace proofmass::estimate
