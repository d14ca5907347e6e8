#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "proofmass/calibrate/draw.hpp"
#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// The poses that a fit used, and how far each input of it is uncertain.
struct DrawnFrom {
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> forces_mps2;  ///< calibrated
  std::vector<Eigen::Matrix3d> roots;        ///< of the covariance of each mean
  std::array<Eigen::MatrixXd, 3> between;    ///< MultiPositionOptions::between of these poses
  /// Roots of the covariances of all means, axis by axis; empty where they are independent.
  std::array<Eigen::MatrixXd, 3> axis_roots;
  Eigen::Matrix3d reading;             ///< (T diag(1/scale))⁻¹
  double orthogonality_std_rad = 0.0;  ///< norm_6: of the angles it leaves out
  double placement_std_rad = 0.0;      ///< six_position, given_12: of each position's tilt
};

/// The covariances are those of the means times the scatter that the fit found; where they are not
/// known, the residuals' own scatter, alike on all axes.
[[nodiscard]] DrawnFrom drawn_from(View<Pose> poses,
                                   const MultiPositionOptions& options,
                                   const MultiPosition& fit);

/// The poses as they might as well have been read.
[[nodiscard]] std::vector<Pose> redrawn(const DrawnFrom& from,
                                        const MultiPosition& fit,
                                        Draw& draw);

}  // namespace proofmass::calibrate
