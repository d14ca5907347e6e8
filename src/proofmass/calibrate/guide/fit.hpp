#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/calibrate/pose.hpp"
#include "proofmass/calibrate/pose_guide.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::calibrate {

/// Turns readings into forces in units of g.
struct ForceReader {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d correction = Eigen::Matrix3d::Identity();

  [[nodiscard]] Eigen::Vector3d force(const Eigen::Vector3d& mean) const {
    return correction * (mean - bias);
  }
};

/// Fit to the poses of a procedure in progress. Gravity is the unit, so the unit of the output does
/// not matter.
class GuideFit {
 public:
  /// nullopt if the poses do not determine a fit.
  [[nodiscard]] static std::optional<GuideFit> of(View<Pose> poses, double noise_dof);

  [[nodiscard]] bool has_nine() const { return fit_.model == PoseModel::norm_9; }
  /// The largest standard deviation of bias, scale and angles, as an error at 1 g.
  [[nodiscard]] double error_g() const;
  /// Output at 1 g of the least sensitive axis.
  [[nodiscard]] double one_g() const;
  [[nodiscard]] ForceReader reader() const;
  [[nodiscard]] GuideFigures figures() const;
  [[nodiscard]] GuideMaps maps() const;
  /// `up` is zero if no position is left.
  [[nodiscard]] NextPose next(View<Eigen::Vector3d> taken) const;
  [[nodiscard]] const std::vector<PoseResidual>& poses() const { return fit_.poses; }

 private:
  explicit GuideFit(MultiPosition fit);

  MultiPosition fit_;
  Parameters raw_;              ///< in the output's unit
  Parameters p_;                ///< with outputs in units of the scale
  ParameterMatrix covariance_;  ///< of p_
};

}  // namespace proofmass::calibrate
