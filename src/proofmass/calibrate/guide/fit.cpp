#include "proofmass/calibrate/guide/fit.hpp"

#include <algorithm>
#include <utility>

#include "proofmass/calibrate/multi_position/pose_design.hpp"
#include "proofmass/core/linalg.hpp"

namespace proofmass::calibrate {

std::optional<GuideFit> GuideFit::of(View<Pose> poses, double noise_dof) {
  constexpr std::size_t fewest = 6;
  if (poses.size() < fewest) return std::nullopt;
  Result<MultiPosition> found =
      calibrate_positions(poses, {.gravity_mps2 = 1.0, .noise_dof = noise_dof});
  if (!found) return std::nullopt;
  return GuideFit(std::move(found).value());
}

GuideFit::GuideFit(MultiPosition fit) : fit_(std::move(fit)), raw_(fit_.estimate.data()) {
  Parameters size = Parameters::Ones();
  size.head<3>() = size.segment<3>(3) = raw_.segment<3>(3);
  p_ = raw_.cwiseQuotient(size);
  const Parameters back = size.cwiseInverse();
  covariance_ = back.asDiagonal() * fit_.covariance * back.asDiagonal();
}

double GuideFit::error_g() const {
  return errors_at_1g(covariance_, p_).maxCoeff();
}

double GuideFit::one_g() const {
  return raw_.segment<3>(3).cwiseAbs().minCoeff();
}

ForceReader GuideFit::reader() const {
  return {raw_.head<3>(), correction(raw_)};
}

NextPose GuideFit::next(View<Eigen::Vector3d> taken) const {
  constexpr double least = 1e-12;  // of a variance in g²: unknown noise
  double squares = 0.0;
  for (const PoseResidual& pose : fit_.poses)
    squares += std::max(pose.predicted_std_mps2 * pose.predicted_std_mps2, least);
  return next_pose(positive_inverse(covariance_), p_,
                   squares / static_cast<double>(fit_.poses.size()), taken);
}

}  // namespace proofmass::calibrate
