#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// How far the length of a calibrated reading at rest is off, one standard deviation, in m/s².
struct RestAccuracy {
  double overall_mps2 = 0.0;   ///< root mean square over all directions
  double scatter_mps2 = 0.0;   ///< of positions like these about the model
  double by_noise_mps2 = 0.0;  ///< overall, without the shares of type B
  std::string main_type_b;     ///< source of the largest of those; empty if there are none
  double worst_mps2 = 0.0;     ///< in the direction that these positions tell the least of
  Eigen::Vector3d worst_up = Eigen::Vector3d::Zero();  ///< which is this, in the sensor's axes
};

/// overall² = scatter² + mean over the sphere of j C jᵀ, with j the gradient of |f| by the nine
/// parameters, C their covariance. The scatter is that of the noise of the means, or of the
/// residuals with their degrees of freedom where noise does not explain them or is not known.
/// None where dof is 0. Cost: 200 directions.
[[nodiscard]] std::optional<RestAccuracy> rest_accuracy(const MultiPosition& fit);

}  // namespace proofmass::calibrate
