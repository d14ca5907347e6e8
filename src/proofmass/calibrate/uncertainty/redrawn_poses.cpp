#include "proofmass/calibrate/uncertainty/redrawn_poses.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "proofmass/calibrate/multi_position/norm_model.hpp"
#include "proofmass/calibrate/multi_position/pose_selection.hpp"
#include "proofmass/calibrate/uncertainty/correlation.hpp"

namespace proofmass::calibrate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Parameters estimate_of(const MultiPosition& fit) {
  return Eigen::Map<const Parameters>(fit.estimate.data());
}

bool noise_is_known(View<Pose> poses, double noise_dof) {
  return noise_dof > 0.0 && std::ranges::all_of(poses, [](const Pose& pose) {
           return pose.mean_covariance.diagonal().minCoeff() > 0.0;
         });
}

double free_parameters(const MultiPosition& fit) {
  return fit.model == PoseModel::norm_6 ? 6.0 : 9.0;
}

// The variance of |f| from a covariance of the mean.
double length_variance(const Vector3d& force, const Matrix3d& correction, const Matrix3d& of_mean) {
  const Vector3d n = correction.transpose() * force.normalized();
  return n.dot(of_mean * n);
}

// Factor on the variances of the means with which they explain the residuals.
double scatter_factor(const std::vector<Pose>& used,
                      const std::vector<double>& residuals,
                      const DrawnFrom& from,
                      const MultiPosition& fit,
                      double noise_dof) {
  if (fit.model == PoseModel::six_position) return noise_dof > 0.0 ? 1.0 : 0.0;
  // Where the noise is known, with the covariances between the poses.
  if (fit.lack_of_fit && noise_dof > 0.0)
    return scatter_of(fit.lack_of_fit->statistic * fit.lack_of_fit->dof, fit.lack_of_fit->dof,
                      noise_dof)
        .factor;
  const Matrix3d M = correction(estimate_of(fit));
  double rss = 0.0;
  for (std::size_t k = 0; k < used.size(); ++k)
    rss += residuals[k] * residuals[k] /
           length_variance(from.forces_mps2[k], M, used[k].mean_covariance);
  const double dof = std::max(0.0, static_cast<double>(used.size()) - free_parameters(fit));
  return scatter_of(rss, dof, noise_dof).factor;
}

Vector3d three_normal(Draw& draw) {
  const double x = draw.normal(), y = draw.normal(), z = draw.normal();
  return {x, y, z};
}

// For all poses, if their means are not independent.
Eigen::Matrix3Xd drawn_noise(const DrawnFrom& from, Draw& draw) {
  if (from.axis_roots[0].size() == 0) return {};
  const auto n = static_cast<Eigen::Index>(from.poses.size());
  Eigen::Matrix3Xd noise(3, n);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd normal(n);
    for (double& value : normal) value = draw.normal();
    noise.row(axis) = (from.axis_roots[static_cast<std::size_t>(axis)] * normal).transpose();
  }
  return noise;
}

Vector3d turned(const Vector3d& v, const Vector3d& by_rad) {
  const double angle = by_rad.norm();
  return angle > 0.0 ? Vector3d(Eigen::AngleAxisd(angle, by_rad / angle) * v) : v;
}

// The covariances between the means of different poses, times the factor required by the residuals.
void draw_between(const MultiPositionOptions& options,
                  const MultiPosition& fit,
                  double factor,
                  DrawnFrom& from) {
  std::vector<Eigen::Index> used;
  for (std::size_t k = 0; k < fit.poses.size(); ++k)
    if (fit.poses[k].used) used.push_back(static_cast<Eigen::Index>(k));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (options.between[axis].rows() != static_cast<Eigen::Index>(fit.poses.size())) continue;
    from.between[axis] = options.between[axis](used, used);
    Eigen::MatrixXd covariance = from.between[axis];
    const auto place = static_cast<Eigen::Index>(axis);
    for (std::size_t k = 0; k < from.poses.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      covariance(row, row) = from.poses[k].mean_covariance(place, place);
    }
    from.axis_roots[axis] = std::sqrt(factor) * root_of(covariance);
  }
}

}  // namespace

DrawnFrom drawn_from(View<Pose> poses,
                     const MultiPositionOptions& options,
                     const MultiPosition& fit) {
  const bool known = noise_is_known(poses, options.noise_dof);
  DrawnFrom from;
  std::vector<double> residuals;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!fit.poses[k].used) continue;
    from.poses.push_back(poses[k]);
    if (!known) from.poses.back().mean_covariance = Matrix3d::Identity();
    // Six positions are drawn about their nominal directions: the measured ones already include the
    // placement error.
    const bool exact = fit.model == PoseModel::six_position && poses[k].up;
    from.forces_mps2.emplace_back(exact ? Vector3d(fit.gravity_mps2 * poses[k].up->normalized())
                                        : fit.poses[k].force_mps2);
    residuals.push_back(fit.poses[k].residual_mps2);
  }
  const double factor =
      scatter_factor(from.poses, residuals, from, fit, known ? options.noise_dof : 0.0);
  for (const Pose& pose : from.poses)
    from.roots.emplace_back(std::sqrt(factor) * root_of(pose.mean_covariance));
  if (known) draw_between(options, fit, factor, from);
  if (!known)
    for (Pose& pose : from.poses) pose.mean_covariance.setZero();
  from.reading = correction(estimate_of(fit)).inverse();
  if (fit.model == PoseModel::norm_6 || fit.model == PoseModel::six_position)
    from.orthogonality_std_rad = options.orthogonality_std_rad;
  if (fit.model == PoseModel::six_position) from.placement_std_rad = options.placement_std_rad;
  if (fit.model == PoseModel::given_12)
    from.placement_std_rad = fit.placement_std_rad.value_or(0.0);
  return from;
}

std::vector<Pose> redrawn(const DrawnFrom& from, const MultiPosition& fit, Draw& draw) {
  Parameters p = estimate_of(fit);
  p.tail<3>() += from.orthogonality_std_rad * three_normal(draw);
  const Matrix3d reading = correction(p).inverse();
  std::vector<Pose> poses = from.poses;
  const Eigen::Matrix3Xd of_axes = drawn_noise(from, draw);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Vector3d noise = of_axes.size() > 0 ? Vector3d(of_axes.col(column))
                                              : Vector3d(from.roots[k] * three_normal(draw));
    const Vector3d& force = from.forces_mps2[k];
    const Vector3d placed = turned(force, from.placement_std_rad * three_normal(draw));
    poses[k].mean += noise + (reading * placed - from.reading * force);
  }
  return poses;
}

}  // namespace proofmass::calibrate
