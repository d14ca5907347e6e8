#pragma once

#include <Eigen/Core>
#include <vector>

// White noise plus drift, in blocks some of which may be missing: the residuals of a slow curve.
namespace proofmass::characterise {

struct DriftingNoise {
  double white_variance = 0.0;
  std::vector<double> drift;  ///< autocovariance at a lag of 0, 1, … blocks
};

/// Noise of the residuals of y, the last of the columns, from regression on all others; places are
/// ascending integers. It is the mean over the models
///     y = X b + w + m,     w white of variance s²,     m the blocks' means of a Markov process of
///                          variance s² M and correlation exp(−|t|/memory),
/// with memories from about a block to four times the record, where m is a random walk, and drifts
/// from negligible to far above the white noise. The weight of each is prior · exp(−loss/2),
///     loss = (n − p) ln s² + ln |V| + ln |Xᵀ V⁻¹ X|,     s² = yᵀ P y / (n − p),
/// V in units of s², the prior flat in the memory and in the standard deviation of m's steps. The
/// mean is used instead of the maximum, which often has no drift if the record is too short to show
/// it, and then understates the possible slow error. Source: H. D. Patterson, R. Thompson, Recovery
/// of inter-block information when block sizes are unequal, Biometrika 58 (1971) 545; D. A.
/// Harville, Maximum likelihood approaches to variance component estimation, J. Amer. Statist.
/// Assoc. 72 (1977) 320. Cost: some 200 passes over the rows.
[[nodiscard]] DriftingNoise likely_noise(const Eigen::MatrixXd& columns,
                                         const std::vector<double>& places);

/// Covariance of the drift at the places.
[[nodiscard]] Eigen::MatrixXd drift_covariance(const DriftingNoise& noise,
                                               const std::vector<double>& places);

}  // namespace proofmass::characterise
