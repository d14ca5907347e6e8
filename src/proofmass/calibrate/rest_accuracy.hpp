#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// Error of the norm of a calibrated measurement at rest, one standard deviation, in m/s².
struct RestAccuracy {
  double overall_mps2 = 0.0;   ///< root mean square over all directions
  double scatter_mps2 = 0.0;   ///< scatter of positions like these about the model
  double by_noise_mps2 = 0.0;  ///< overall, without the type B shares
  std::string main_type_b;     ///< source of the largest type B share; empty if there is none
  double worst_mps2 = 0.0;     ///< in the direction least determined by these positions
  Eigen::Vector3d worst_up = Eigen::Vector3d::Zero();  ///< that direction, in the sensor's axes
};

/// overall² = scatter² + mean over the sphere of j C jᵀ, with j the gradient of |f| by the nine
/// parameters, C their covariance. The scatter is that of the noise of the means, or of the
/// residuals with their degrees of freedom if noise does not explain them or is unknown. Absent if
/// dof is 0. Cost: 200 directions.
[[nodiscard]] std::optional<RestAccuracy> rest_accuracy(const MultiPosition& fit);

}  // namespace proofmass::calibrate
