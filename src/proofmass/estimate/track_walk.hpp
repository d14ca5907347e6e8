#pragma once

#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/estimate/inertial_axis.hpp"
#include "proofmass/estimate/track.hpp"

// What the bias and the attitude do while the sensor moves: told by how far the velocity misses 0
// at each stop, and how far the level has moved. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// Posterior of what the acceleration errs by in motion beyond what it does at rest, on a grid:
/// the walk q and the jump J of the bias, and the rocking L.
struct MotionError {
  /// Means: variances grow straight with them.
  double walk_m2ps5 = 0.0, jump_m2ps4 = 0.0, lean_m2ps3 = 0.0;
  double factor_95 =
      1.96;  ///< half width of a 95 % interval in standard deviations, by the mixture
};

/// Weight ∝ likelihood of the measurements · prior. Each of the three is nothing with probability
/// 3/4, else log₁₀ of its root is normal about −2.5 with a standard deviation of 0.7, in m/s²/√s,
/// m/s² and m/s²/√Hz: a sensor that is carried by hand or on a machine. Where it shakes in motion
/// more than at rest, nine tenths of the probability that nothing rocks are on all of that being
/// aliased, and so white. The bias walks in motion no less than at rest. Source for the mixture
/// instead of one value: A. Gelman et al., Bayesian Data Analysis (2013), section 5. Cost: 1728
/// passes over the knots, a twelfth more where it shakes.
[[nodiscard]] MotionError motion_error(View<InertialEpoch> knots,
                                       InertialNoise noise,
                                       const InertialStart& start);

/// Logarithm of the likelihood of the measurements, the three integrated out over the same prior.
[[nodiscard]] double log_evidence(View<InertialEpoch> knots,
                                  const InertialNoise& noise,
                                  const InertialStart& start);

/// The knots less those in the middle of long rests, which say nothing of the motion around.
[[nodiscard]] std::vector<InertialEpoch> without_middles(View<InertialEpoch> knots);

/// Half width of the central 95 % of a mixture of normals about 0, over the root of its variance.
/// The weights sum to 1.
[[nodiscard]] double mixture_factor(View<double> weight, View<double> variance);

/// How little each rest was expected, in their order: yᵀ S⁻¹ y of the velocity on arrival and of
/// the first level there, two degrees of freedom. NaN of a rest at the very start.
[[nodiscard]] std::vector<double> surprise_of_rests(View<InertialEpoch> knots,
                                                    const InertialNoise& noise,
                                                    const InertialStart& start);

/// The velocity left over on arrival at each stop of the forward filter.
[[nodiscard]] std::vector<Closure> closures(View<InertialEpoch> knots,
                                            const InertialNoise& noise,
                                            const InertialStart& start,
                                            ConsistencyCheck& check);

}  // namespace proofmass::estimate
