#pragma once

#include <vector>

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift_model.hpp"

namespace proofmass::characterise {

/// Fit of the warm-up to the block means of a sensor at rest, by fit_drift. All shapes are fitted,
/// each with its own noise, and compared by Schwarz's criterion. An exponential is identified if
///
/// - the best shape has one;
/// - it explains more than a constant, with the same noise and with the noise that suits the
///   constant, at a level of 1 %, including the search over T: p = P(χ²₁ > D) + (L/π) e^(−D/2), L
///   the length of the path of the whitened exponential over the unit sphere as T runs through its
///   range;
/// - T lies within the record and its interval is closed there;
/// - the whitened residual is not far from white (p ≥ 1e-6): otherwise the likelihood, and all
///   results from it, assume the wrong noise.
///
/// Source: for p R. B. Davies, Hypothesis testing when a nuisance parameter is present only under
/// the alternative, Biometrika 74 (1987) 33; H. Hotelling, Tubes and spheres in n-spaces, Amer. J.
/// Math. 61 (1939) 440. For the criterion G. Schwarz, Ann. Statist. 6 (1978) 461.
struct FittedDrift {
  DriftFit fit;
  /// The block means minus curve and fitted noise: white if the noise model is adequate; NaN for a
  /// missing block.
  std::vector<double> whitened;
  /// The bias in each block from curve and noise model: curve plus drift, with the white noise
  /// filtered. The most likely value across a gap.
  std::vector<double> bias;
};

[[nodiscard]] FittedDrift fit_drift(const DriftEvidence& evidence);

}  // namespace proofmass::characterise
