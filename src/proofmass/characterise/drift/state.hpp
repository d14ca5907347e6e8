#pragma once

#include "proofmass/characterise/drift/evidence.hpp"
#include "proofmass/characterise/drift/fit_at_shape.hpp"
#include "proofmass/characterise/drift_model.hpp"

namespace proofmass::characterise {

/// The noise of a trial as strengths.
[[nodiscard]] DriftNoise noise_of(const DriftFitAtShape& trial);

/// Curve of a fitted shape, and the bias at the end.
struct PlacedCurve {
  DriftCurve curve;
  DriftState end;
};

/// The level is that at t = 0: a random walk starts there, flicker and Markov noise about their
/// mean. Given the curve, each term's part of a residual ordinate r_k is S_j/S r_k with covariance
/// δ_ij S_i − S_i S_j/S (the Wiener filter); sums of them with the transform's weights give the
/// walk at both ends, and the curve's own uncertainty is carried through.
[[nodiscard]] PlacedCurve place(const DriftEvidence& evidence, const DriftFitAtShape& trial);

}  // namespace proofmass::characterise
