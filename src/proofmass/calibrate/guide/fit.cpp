#include "proofmass/calibrate/guide/fit.hpp"

#include <algorithm>
#include <cmath>
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

GuideFigures GuideFit::figures() const {
  const Parameters std = covariance_.diagonal().cwiseSqrt();
  const Eigen::Vector3d scale = raw_.segment<3>(3);
  return {.bias_g = p_.head<3>(),
          .bias_std_g = std.head<3>(),
          .scale = scale,
          .scale_std = std.segment<3>(3).cwiseProduct(scale.cwiseAbs()),
          .angles_rad = p_.tail<3>(),
          .angle_std_rad = std.tail<3>()};
}

GuideMaps GuideFit::maps() const {
  const Eigen::Matrix3d back = correction(p_).inverse();
  const auto std_g = [&](const Eigen::Vector3d& up) {
    const NormalisedPose pose{p_.head<3>() + back * up, Eigen::Matrix3d::Zero()};
    const auto gradient = norm_term(p_, pose).gradient;
    return std::sqrt(std::max(0.0, gradient.dot(gradient * covariance_)));
  };
  GuideMaps maps;
  constexpr Eigen::Index size = GuideMaps::size;
  const auto coordinate = [](Eigen::Index k) {
    return 2.0 * static_cast<double>(k) / (size - 1) - 1.0;
  };
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < size; ++k) {
      const double u = coordinate(k), v = coordinate(i), r2 = u * u + v * v;
      // With r = √2 sin(θ/2): cos θ = 1 − r², sin θ = r √(2 − r²).
      const double along = 1.0 - r2, flat = std::sqrt(std::max(0.0, 2.0 - r2));
      maps.plus_z_g(i, k) = std_g({u * flat, v * flat, along});
      maps.minus_z_g(i, k) = std_g({-u * flat, v * flat, -along});
    }
  maps.largest_g = std::max(maps.plus_z_g.maxCoeff(), maps.minus_z_g.maxCoeff());
  return maps;
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
