#pragma once

#include <vector>

#include "proofmass/characterise/drift_evidence.hpp"
#include "proofmass/characterise/drift_model.hpp"

namespace proofmass::characterise {

/// What the block means of a sensor at rest say of its warm-up, by fit_drift. All shapes are tried,
/// each with its own noise, and compared by Schwarz's criterion. An exponential is identified where
///   - the best shape has one;
///   - it explains more than a constant does with the same noise, and with the noise that suits the
///     constant, at a level of 1 %, the search over T included:
///     p = P(χ²₁ > D) + (L/π) e^(−D/2), L the length of the path that the whitened exponential
///     takes over the unit sphere as T runs through its range;
///   - T lies within the record and its interval is closed there;
///   - what is left, the noise divided out, is not far from white (p ≥ 1e-6): else the likelihood,
///     and all that follows from it, is of another noise.
/// Source: of p R. B. Davies, Hypothesis testing when a nuisance parameter is present only under
/// the alternative, Biometrika 74 (1987) 33; H. Hotelling, Tubes and spheres in n-spaces, Amer. J.
/// Math. 61 (1939) 440. Of the criterion G. Schwarz, Ann. Statist. 6 (1978) 461.
struct FittedDrift {
  DriftFit fit;
  /// The block means less curve and fitted noise: white where the noise is what the fit took it
  /// for; NaN where a block is missing.
  std::vector<double> whitened;
  /// The bias in each block as curve and noise model see it together: the curve and its wander, the
  /// white noise filtered off. Across a gap what is most likely.
  std::vector<double> bias;
};

[[nodiscard]] FittedDrift fit_drift(const DriftEvidence& evidence);

}  // namespace proofmass::characterise
