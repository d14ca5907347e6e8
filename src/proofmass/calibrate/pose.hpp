#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

namespace proofmass::calibrate {

/// What one accelerometer read while it lay still.
struct Pose {
  std::string label;                     ///< as the user named it; empty if he did not
  std::optional<double> start_s, end_s;  ///< within the recording, where there is one
  std::size_t samples = 0;               ///< behind the mean; 0 where only the mean is known
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< reading of x, y, z: m/s^2, V or counts
  /// Of the mean, by noise alone, in the reading's unit squared; zero where nobody knows it.
  Eigen::Matrix3d mean_covariance = Eigen::Matrix3d::Zero();
  /// The part of its diagonal that the converter's steps make, in every mean however long.
  Eigen::Vector3d rounding_variance = Eigen::Vector3d::Zero();
  /// Unit vector along the force (upwards) in the frame of the fixture, where it is given.
  std::optional<Eigen::Vector3d> up;
};

}  // namespace proofmass::calibrate
