#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "proofmass/calibrate/gyroscope/data.hpp"

// Bias and g-sensitivity from the means at rest.
namespace proofmass::calibrate {

/// mean = bias + G f, axis by axis.
struct RestRegression {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  /// Covariance of bias and the row of G of each axis, scatter included.
  std::array<Eigen::Matrix4d, 3> covariance;
  std::array<double, 3> dof{};  ///< of the scatter of each axis; 0: unknown
  std::string why_no_g;         ///< empty: G is determined
  std::optional<LackOfFit> lack_of_fit;
};

/// Generalised least squares. `earth` holds what Earth's rotation is known to add to each mean;
/// `earth_variance` is the variance of what it adds beyond.
///
/// The bias drifts between the rests as a random walk, whose strength is that of the means: the
/// covariance is the average over a grid of strengths, the first of them 0 with half of the prior
/// probability, by the restricted likelihood. The variance is then multiplied by the scatter if the
/// residuals are significant at 5 %.
///
/// Source: D. A. Harville, J. Amer. Statist. Assoc. 72 (1977) 320. Cost: O(rests³) for each
/// strength.
[[nodiscard]] RestRegression regress_rests(const GyroscopeData& data,
                                           const std::vector<Eigen::Vector3d>& earth,
                                           const Eigen::Vector3d& earth_variance);

}  // namespace proofmass::calibrate
