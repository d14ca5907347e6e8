#pragma once

#include <optional>
#include <vector>

#include "proofmass/estimate/tilt/rest.hpp"

// The biases of a sensor without calibration, or whether they have changed since it.
namespace proofmass::estimate {

struct BiasChange {
  /// Posterior probability that the biases have changed by other than the usual amount, with equal
  /// prior odds.
  double probability = 0.0;
  double std_mps2 = 0.0;  ///< uncertainty of each axis's bias beyond the calibration
};

/// From the norms of the force at rest, n_i = |f_i| − G, with unit vectors u_i along f_i:
///
///     n ~ N(0, U C Uᵀ + diag(noise) + σ_G² 1 1ᵀ + b² U Uᵀ),
///
/// with C the covariance of the calibration (0 without one) and b the standard deviation of the
/// change of each axis's bias.
///
/// - Prior of b: the stated stability with probability 0.9, or 0 with probability 0.1 if none is
///   stated; otherwise ln b is uniform from 0.2 to 60 mg, from the turn-on repeatability of a good
///   MEMS accelerometer to the effect of a shock. With a uniform logarithm the coverage of the
///   interval from one norm does not depend on b.
/// - `std_mps2` is such that ± 1.96 of it, with C, is the 95 % interval of the mixture: the norm
///   shows only the part along gravity, the tilt error comes from the parts across it.
/// - At most 16 rests with a norm are compared, spread over the recording; without any, the prior
///   is the result.
[[nodiscard]] BiasChange bias_change(const std::vector<TiltRest>& rests,
                                     const ForceSpread& spread,
                                     const Uncertain& gravity_mps2,
                                     std::optional<double> stability_mps2);

/// The same for a sensor without calibration: uncertainty of each axis's bias. Prior: ln b is
/// normal with a median of 10 mg and a standard deviation of 1, so that b is 1.4 to 71 mg with a
/// probability of 95 %. Datasheets of MEMS accelerometers state zero-g offsets of 20 to 80 mg
/// before trimming by the user, phones and inertial modules have some milli-g.
[[nodiscard]] double uncalibrated_bias_std_mps2(const std::vector<TiltRest>& rests,
                                                const ForceSpread& spread,
                                                const Uncertain& gravity_mps2);

}  // namespace proofmass::estimate
