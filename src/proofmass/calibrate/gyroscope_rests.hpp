#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "proofmass/calibrate/gyroscope_data.hpp"

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

/// Weighted least squares. `earth` holds what Earth's rotation is known to add to each mean;
/// `earth_variance` is the variance of what it adds beyond. The variance of an axis is the larger
/// of its noise and its scatter, which contains the drift of the bias between rests.
[[nodiscard]] RestRegression regress_rests(const GyroscopeData& data,
                                           const std::vector<Eigen::Vector3d>& earth,
                                           const Eigen::Vector3d& earth_variance);

}  // namespace proofmass::calibrate
