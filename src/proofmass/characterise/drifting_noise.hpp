#pragma once

#include <Eigen/Core>
#include <vector>

// White noise with a drift beneath it, at the places of blocks that may be missing here and there:
// what the residuals of a slow curve are made of.
namespace proofmass::characterise {

struct DriftingNoise {
  double white_variance = 0.0;
  std::vector<double> drift;  ///< autocovariance at a lag of 0, 1, … blocks
};

/// The noise that the residuals of y, the last of the columns, from regression on all others leave
/// likely, places being whole numbers that ascend. It is the mean over the models
///     y = X b + w + m,     w white of variance s²,     m the blocks' means of a Markov process of
///                          variance s² M and correlation exp(−|t|/memory),
/// memories from a block or so to four times the record, where m is a random walk, and drifts from
/// none to speak of to far above the white noise. Each weighs prior · exp(−loss/2),
///     loss = (n − p) ln s² + ln |V| + ln |Xᵀ V⁻¹ X|,     s² = yᵀ P y / (n − p),
/// V in units of s², the prior flat in the memory and in the standard deviation of m's steps.
/// The mean rather than the likeliest: that often has no drift at all where the record is too short
/// to show it, and then understates what a slow cause may owe to it.
/// Source: H. D. Patterson, R. Thompson, Recovery of inter-block information when block sizes are
/// unequal, Biometrika 58 (1971) 545; D. A. Harville, Maximum likelihood approaches to variance
/// component estimation, J. Amer. Statist. Assoc. 72 (1977) 320.
/// Cost: some 200 passes over the rows.
[[nodiscard]] DriftingNoise likely_noise(const Eigen::MatrixXd& columns,
                                         const std::vector<double>& places);

/// Covariance of the drift at the places.
[[nodiscard]] Eigen::MatrixXd drift_covariance(const DriftingNoise& noise,
                                               const std::vector<double>& places);

}  // namespace proofmass::characterise
