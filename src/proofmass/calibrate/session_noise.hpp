#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"

// Noise correlated between positions.
namespace proofmass::calibrate {

struct SessionNoise {
  std::vector<Pose> poses;                 ///< as given, with covariances over the session
  std::array<Eigen::MatrixXd, 3> between;  ///< MultiPositionOptions::between
  /// Allan variances of flicker noise and random walk over one sample: the mean over the grid plus
  /// one standard deviation, since noise beyond the session is not observed.
  std::array<double, 3> flicker{}, random_walk{};
};

/// Scatter of the means about the calibration with the session's mean bias. Within a rest the bias
/// drifts less than from the first position to the last, so rests alone do not determine it; the
/// residuals of the fit do, but are few. Both are combined, with flicker noise and a random walk in
/// fixed ratios f and k to the white noise of each axis:
///
///     σ²(m) = N² (1/m + f + k m),    C = N²/m + N² (f C_flicker + k C_walk).
///
/// - Likelihood: that of the rests' Allan variances (χ² variables; at most 150 pairs of a level
///   count, since no spectrum is that simple) times the restricted likelihood of the residuals.
/// - Grid of f and k, the first of each 0, with half of the prior probability there; C is the mean
///   over the grid.
/// - One bad position is allowed for, so that its error is not attributed to drift.
///
/// `sessions` in the order of the poses; different sessions are independent. nullopt if the poses
/// do not determine norm_9 or the noise is unknown. Source: D. A. Harville, J. Amer. Statist.
/// Assoc. 72 (1977) 320 (restricted likelihood). Cost: one calibration and O(poses³) for each of
/// 100 points of the grid.
[[nodiscard]] std::optional<SessionNoise> session_noise(View<Pose> poses,
                                                        View<RestSession> sessions,
                                                        MultiPositionOptions options);

}  // namespace proofmass::calibrate
