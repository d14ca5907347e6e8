#pragma once

#include "proofmass/characterise/noise/cosine_ordinates.hpp"
#include "proofmass/characterise/noise_model.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/signal/spectral_lines.hpp"
#include "proofmass/signal/spectrum.hpp"

namespace proofmass::characterise {

/// Input of a fit: the slow part of the series by cosine transform, the fast part by averaged
/// spectrum, and the bands that are lines, i.e. not noise.
struct NoiseEvidence {
  const BlockMeans& slow;
  const signal::Spectrum& spectrum;
  const signal::LineReport& lines;
  double duration_s;
  SlowWave slow_wave = {};  ///< subtracted from the slow part
};

/// Fits the noise model of a series at rest.
///
/// - The fitted densities are independent, unlike the points of an Allan curve, each of which is a
///   weighted sum of them. The standard deviations therefore include the correlation between
///   neighbouring τ, and lines, which raise the Allan curve for a decade around them, can be
///   omitted.
/// - Terms are dropped, the least significant first, while twice the gain in log-likelihood is
///   below 6 (98.6 % of χ² with one degree of freedom), for a ramp 9 over all that the dropped
///   terms could explain of it.
/// - A Markov term or a bandwidth, each with a free time constant, must gain 16 (false less than
///   once in a thousand over the dozen time constants that a record can resolve). With a bandwidth,
///   quantisation noise is tested with the bandwidth free: near half the rate the two are similar.
/// - Intervals are those of the likelihood ratio with all other coefficients free, including
///   dropped ones, relative to the selected model: S. S. Wilks, Ann. Math. Statist. 9 (1938) 60; at
///   the boundary S. G. Self, K.-Y. Liang, J. Amer. Statist. Assoc. 82 (1987) 605. A standard
///   deviation is that of the selected model.
///
/// Coverage by simulation: noise/coverage_slow_test.cpp.
///
/// Errors: too_few_samples (fewer than 100 samples, or than 16 in one piece). Cost: O(blocks log
/// blocks), then some thousand passes over a few hundred groups.
[[nodiscard]] Result<NoiseModelFit> fit_noise_model(const NoiseEvidence& evidence);

}  // namespace proofmass::characterise
