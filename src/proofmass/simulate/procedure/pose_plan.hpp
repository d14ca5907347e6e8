#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "proofmass/simulate/procedure.hpp"

namespace proofmass::simulate {

/// One position of a procedure. The sensor is in it from stand_s to end_s and at exact rest from
/// rest_s on.
struct PlannedPose {
  double stand_s = 0.0, rest_s = 0.0, end_s = 0.0;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< along the force, in the sensor's axes
  double force_mps2 = 0.0;                        ///< its magnitude
  /// Table only, as in TruePose.
  int plane = 0;
  double mount_rad = 0.0, commanded_rad = 0.0, angle_rad = 0.0;
  Eigen::Matrix3d R_sensor_table = Eigen::Matrix3d::Identity();
  bool turned_here = false;  ///< from the previous position by the table; else by hand
};

/// All positions in order, with their times.
[[nodiscard]] std::vector<PlannedPose> plan_poses(const ProcedureOptions& options);

/// The positions as stored in the truth.
[[nodiscard]] std::vector<TruePose> true_poses(const std::vector<PlannedPose>& plan);

/// The seed of the values that another session draws anew: all except the sensor and the table's
/// own errors.
[[nodiscard]] std::uint64_t session_seed(const ProcedureOptions& options);

/// True if the positions are set by a table.
[[nodiscard]] bool is_on_table(Procedure procedure);

/// Unit force in the table's axes, (sinθ cosβ, cosθ cosβ, sinβ).
[[nodiscard]] Eigen::Vector3d up_on_table(double angle_rad, double axis_tilt_rad);

}  // namespace proofmass::simulate
