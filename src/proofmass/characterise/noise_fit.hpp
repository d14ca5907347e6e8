#pragma once

#include "proofmass/characterise/low_band.hpp"
#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/signal/spectral_lines.hpp"
#include "proofmass/signal/spectrum.hpp"

namespace proofmass::characterise {

/// What a fit is made from: the slow part of the series by cosine transform, the fast part by
/// averaged spectrum, and the bands that are lines and therefore no noise.
struct NoiseEvidence {
  const BlockMeans& slow;
  const signal::Spectrum& spectrum;
  const signal::LineReport& lines;
  double duration_s;
  SlowWave slow_wave = {};  ///< taken out of the slow part
};

/// The noise model of a series at rest.
///
/// The densities that it is fitted to are independent of one another, as the points of an Allan
/// curve are not; each of those is a weighted sum of them. So the standard deviations hold the
/// correlation between neighbouring τ by construction, and lines can be left out, which raise the
/// curve for a decade around them. Terms are left out, the least needed first, while twice the
/// gain in log-likelihood is below 6 (98.6 % of χ² with one degree of freedom), for a ramp 9 over
/// all that the terms left out could explain of it; a Markov term or a bandwidth, each with a free
/// time constant, has to gain 16 (false less than once in a thousand over the dozen time constants
/// that a record can tell apart). Beside a bandwidth quantisation noise is judged with the
/// bandwidth free: near half the rate either passes for a part of the other.
///
/// Intervals are those of the likelihood ratio with all other coefficients free, those left out
/// too, counted from the model that was kept: S. S. Wilks, Ann. Math. Statist. 9 (1938) 60; at the
/// boundary S. G. Self, K.-Y. Liang, J. Amer. Statist. Assoc. 82 (1987) 605. A standard deviation
/// is that of the model that was kept. Coverage by simulation: noise_coverage_slow_test.cpp.
///
/// Errors: too_few_samples (fewer than 100 samples, or than 16 in one piece).
/// Cost: O(blocks log blocks), then some thousand passes over a few hundred groups.
[[nodiscard]] Result<NoiseModelFit> fit_noise_model(const NoiseEvidence& evidence);

}  // namespace proofmass::characterise
