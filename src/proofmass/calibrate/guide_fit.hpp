#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/norm_model.hpp"
#include "proofmass/calibrate/pose.hpp"
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

/// What the poses of a procedure that goes on tell so far. Gravity is the unit, so that what the
/// readings are in does not matter.
class GuideFit {
 public:
  /// nullopt where the poses do not carry a fit.
  [[nodiscard]] static std::optional<GuideFit> of(View<Pose> poses, double noise_dof);

  [[nodiscard]] bool has_nine() const { return fit_.model == PoseModel::norm_9; }
  /// The largest of bias, scale and angles' standard deviations, as an error at 1 g.
  [[nodiscard]] double error_g() const;
  /// Of a reading, by the least sensitive axis.
  [[nodiscard]] double one_g() const;
  [[nodiscard]] ForceReader reader() const;
  /// `up` is zero where no position is over.
  [[nodiscard]] NextPose next(View<Eigen::Vector3d> taken) const;
  [[nodiscard]] const std::vector<PoseResidual>& poses() const { return fit_.poses; }

 private:
  explicit GuideFit(MultiPosition fit);

  MultiPosition fit_;
  Parameters raw_;              ///< in the reading's unit
  Parameters p_;                ///< with readings in units of the scale
  ParameterMatrix covariance_;  ///< of p_
};

}  // namespace proofmass::calibrate
