#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/uncertainty/draw.hpp"

namespace proofmass::calibrate {

/// The poses used by a fit, and the uncertainty of each of its inputs.
struct DrawnFrom {
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> forces_mps2;  ///< calibrated
  std::vector<Eigen::Matrix3d> roots;        ///< of the covariance of each mean
  std::array<Eigen::MatrixXd, 3> between;    ///< MultiPositionOptions::between of these poses
  /// Roots of the covariances of all means, axis by axis; empty if they are independent.
  std::array<Eigen::MatrixXd, 3> axis_roots;
  Eigen::Matrix3d reading;             ///< (T diag(1/scale))⁻¹
  double orthogonality_std_rad = 0.0;  ///< norm_6: of the angles it leaves out
  double placement_std_rad = 0.0;      ///< six_position, given_12: of each position's tilt
};

/// The covariances are those of the means times the estimated scatter; if unknown, the residuals'
/// own scatter, equal on all axes.
[[nodiscard]] DrawnFrom drawn_from(View<Pose> poses,
                                   const MultiPositionOptions& options,
                                   const MultiPosition& fit);

/// A random replication of the poses.
[[nodiscard]] std::vector<Pose> redrawn(const DrawnFrom& from,
                                        const MultiPosition& fit,
                                        Draw& draw);

}  // namespace proofmass::calibrate
