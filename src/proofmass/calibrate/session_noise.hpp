#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"

// Noise that goes on from one position to the next.
namespace proofmass::calibrate {

struct SessionNoise {
  std::vector<Pose> poses;                 ///< as given, with covariances over the session
  std::array<Eigen::MatrixXd, 3> between;  ///< MultiPositionOptions::between
  /// Allan variances of the wander, flicker noise's and the random walk's over one sample: the mean
  /// over the grid and a standard deviation more, for what lies beyond the session is not seen.
  std::array<double, 3> flicker{}, random_walk{};
};

/// How the means scatter about the calibration of the session's mean bias. Within a rest the bias
/// wanders less than from the first position to the last, so that rests alone do not say; the
/// residuals of the fit do, but are few. Both together: with flicker noise and a random walk in
/// fixed ratios f and k to the white noise of each axis,
///
///     σ²(m) = N² (1/m + f + k m),    C = N²/m + N² (f C_flicker + k C_walk),
///
/// the likelihood of the rests' Allan variances (χ² variables; of a level at most 150 pairs count,
/// for no spectrum is so simple) times the restricted likelihood of the residuals is taken at a
/// grid of f and k, of each the first 0, with half of the prior probability there; C is the mean
/// over the grid. That one position is bad is allowed for, lest its error pass for a wander.
///
/// `sessions` in the order of the poses; different sessions are independent. The wander is null
/// where norm_9 is not carried or the noise is not known: nullopt.
/// Source: D. A. Harville, J. Amer. Statist. Assoc. 72 (1977) 320 (restricted likelihood).
/// Cost: one calibration and O(poses³) for each of 100 points of the grid.
[[nodiscard]] std::optional<SessionNoise> session_noise(View<Pose> poses,
                                                        View<RestSession> sessions,
                                                        MultiPositionOptions options);

}  // namespace proofmass::calibrate
