#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

namespace proofmass::calibrate {

/// Output of one accelerometer at rest in one position.
struct Pose {
  std::string label;                               ///< as named by the user; may be empty
  std::optional<double> start_s, end_s;            ///< within the recording, if there is one
  std::size_t samples = 0;                         ///< in the mean; 0 if only the mean is known
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< output of x, y, z: m/s^2, V or counts
  /// Covariance of the mean due to noise alone, in the output's unit squared; zero if unknown.
  Eigen::Matrix3d mean_covariance = Eigen::Matrix3d::Zero();
  /// The part of its diagonal due to quantisation, which averaging does not reduce.
  Eigen::Vector3d rounding_variance = Eigen::Vector3d::Zero();
  /// Unit vector along the force (upwards) in the frame of the fixture, if given.
  std::optional<Eigen::Vector3d> up;
};

}  // namespace proofmass::calibrate
