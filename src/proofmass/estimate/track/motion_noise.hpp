#pragma once

#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/models/inertial_1d.hpp"
#include "proofmass/estimate/track.hpp"

// Errors of bias and attitude in motion, from the closure velocity at each stop and the change of
// the level.
namespace proofmass::estimate {

/// Posterior of the additional acceleration errors in motion, on a grid: the random walk q and the
/// jump J of the bias, and the rocking L.
struct MotionError {
  /// Posterior means: variances are linear in them.
  double walk_m2ps5 = 0.0, jump_m2ps4 = 0.0, lean_m2ps3 = 0.0;
  double factor_95 =
      1.96;  ///< half width of a 95 % interval in standard deviations, by the mixture
};

/// Weight ∝ likelihood of the measurements · prior.
///
/// - Each of the three is zero with probability 3/4, else log₁₀ of its root is normal about −2.5
///   with a standard deviation of 0.7, in m/s²/√s, m/s² and m/s²/√Hz: a sensor carried by hand or
///   on a machine.
/// - With more vibration in motion than at rest, nine tenths of the probability of no rocking are
///   assigned to all of it being aliased, and so white.
/// - The random walk of the bias in motion is at least that at rest.
///
/// Source for the mixture instead of one value: A. Gelman et al., Bayesian Data Analysis (2013),
/// section 5. Cost: 1728 passes over the knots, a twelfth more with vibration.
[[nodiscard]] MotionError motion_error(View<InertialEpoch> knots,
                                       InertialNoise noise,
                                       const InertialStart& start);

/// Log-likelihood of the measurements, with the three integrated out over the same prior.
[[nodiscard]] double log_evidence(View<InertialEpoch> knots,
                                  const InertialNoise& noise,
                                  const InertialStart& start);

/// The knots without those in the middle of long rests, which contain no information on the motion.
[[nodiscard]] std::vector<InertialEpoch> without_middles(View<InertialEpoch> knots);

/// Half width of the central 95 % of a zero-mean mixture of normals, over the root of its variance.
/// The weights sum to 1.
[[nodiscard]] double mixture_factor(View<double> weight, View<double> variance);

/// Surprise of each rest, in their order: yᵀ S⁻¹ y of the velocity on arrival and of the first
/// level there, two degrees of freedom. NaN for a rest at the very start.
[[nodiscard]] std::vector<double> surprise_of_rests(View<InertialEpoch> knots,
                                                    const InertialNoise& noise,
                                                    const InertialStart& start);

/// The closure velocity at each stop in the forward filter.
[[nodiscard]] std::vector<Closure> closures(View<InertialEpoch> knots,
                                            const InertialNoise& noise,
                                            const InertialStart& start,
                                            ConsistencyCheck& check);

}  // namespace proofmass::estimate
