#pragma once

#include <Eigen/Core>

#include "proofmass/core/view.hpp"

// Effect of bias drift on consecutive means.
namespace proofmass::calibrate {

struct Span {
  double start, end;

  [[nodiscard]] double length() const { return end - start; }
};

/// Type of noise, each with unit coefficient.
enum class SlowNoise {
  flicker,      ///< Allan variance 1 at all times
  random_walk,  ///< Allan variance m over a time m
};

/// Covariance of the means over `spans` about the mean over `whole`, which contains all of them:
///
///     C(I, J) = G(I, J) − G(I, S) − G(J, S) + G(S, S),   G(I, J) = ∫_I ∫_J k(s − t) ds dt /
///     |I||J|,
///
/// with the generalised covariances k(x) = −ln|x| / (2 ln 2) of flicker noise, whose spectrum is
/// h/f with σ² = 2 ln2 h, and k(x) = −3|x|/2 of a random walk, whose increments have the variance
/// 3|x|. What is common to all means cancels in C. Source: G. Matheron, Advances in Applied
/// Probability 5 (1973) 439 (generalised covariances); J. A. Barnes et al., IEEE Trans. Instrum.
/// Meas. 20 (1971) 105, for the Allan variances. Units of time as of `spans`. Cost: O(spans²).
[[nodiscard]] Eigen::MatrixXd slow_noise_covariance(View<Span> spans,
                                                    const Span& whole,
                                                    SlowNoise noise);

}  // namespace proofmass::calibrate
