#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/tune/problem.hpp"

namespace proofmass::estimate {

/// Two white noises of a series from its Allan variance over blocks of m = 1, 2, 4, … samples,
/// σ²(m) = R/m + Q (2m² + 1)/(6m): variances of a measurement and of the level's change per sample.
/// Source: IEEE Std 952-1997, annex C, for discrete samples. Cost: O(N).
struct LevelNoise {
  double R = 0.0, Q = 0.0;
};
[[nodiscard]] LevelNoise allan_start(const TuneSeries& series);

/// Sets every unknown to the best of a few starts: at the Allan variance and, if that does not
/// determine all of them, on a grid; each scaled to the measurements in closed form. Errors:
/// not_observable (the measurements follow the model without any noise).
[[nodiscard]] Status set_start(TuneProblem& problem);

}  // namespace proofmass::estimate
