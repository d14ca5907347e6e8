#include "proofmass/calibrate/rest_accuracy.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "proofmass/calibrate/multi_position/norm_model.hpp"

namespace proofmass::calibrate {
namespace {

// Evenly over the sphere, in a spiral of golden angles.
constexpr int directions = 200;

Eigen::Vector3d direction(int k) {
  const double z = 1.0 - (2.0 * k + 1.0) / directions, flat = std::sqrt(1.0 - z * z);
  const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * k;
  return {flat * std::cos(angle), flat * std::sin(angle), z};
}

double scatter_of_fit(const MultiPosition& fit) {
  double noise = 0.0, residuals = 0.0, used = 0.0;
  bool noise_known = true;
  for (const PoseResidual& pose : fit.poses) {
    if (!pose.used) continue;
    used += 1.0;
    noise += pose.predicted_std_mps2 * pose.predicted_std_mps2;
    residuals += pose.residual_mps2 * pose.residual_mps2;
    noise_known &= pose.predicted_std_mps2 > 0.0;
  }
  if (used == 0.0) return 0.0;
  const bool free = fit.model == PoseModel::norm_9 || fit.model == PoseModel::norm_6;
  const double parameters = !free ? 0.0 : fit.model == PoseModel::norm_9 ? 9.0 : 6.0;
  const double by_noise = std::sqrt(noise / used);
  const double by_residuals =
      used > parameters ? std::sqrt(residuals / (used - parameters)) : by_noise;
  if (!noise_known) return by_residuals;
  const bool explained = free && (!fit.lack_of_fit || fit.lack_of_fit->p >= 0.05);
  return explained ? by_noise : std::max(by_noise, by_residuals);
}

// Gradient of |f| by the parameters, for a measurement at rest with `up` upwards.
Eigen::Matrix<double, 1, 9> gradient(const MultiPosition& fit, const Eigen::Vector3d& up) {
  const Parameters p(fit.estimate.data());
  const Eigen::Vector3d force = fit.gravity_mps2 * up;
  const Eigen::Matrix3d back = correction(p).inverse();
  return norm_term(p, {p.head<3>() + back * force, Eigen::Matrix3d::Zero()}).gradient;
}

// Mean over the sphere of j jᵀ, with which the mean of j C jᵀ is the trace of a product.
ParameterMatrix mean_square_gradient(const MultiPosition& fit) {
  ParameterMatrix mean = ParameterMatrix::Zero();
  for (int k = 0; k < directions; ++k) {
    const Eigen::Matrix<double, 1, 9> j = gradient(fit, direction(k));
    mean += j.transpose() * j / directions;
  }
  return mean;
}

}  // namespace

std::optional<RestAccuracy> rest_accuracy(const MultiPosition& fit) {
  if (!(fit.dof > 0.0)) return std::nullopt;
  RestAccuracy out;
  out.scatter_mps2 = scatter_of_fit(fit);
  const double scatter = out.scatter_mps2 * out.scatter_mps2;
  const ParameterMatrix mean = mean_square_gradient(fit);
  const auto over_sphere = [&](const ParameterMatrix& covariance) {
    return std::max(0.0, mean.cwiseProduct(covariance).sum());
  };
  double type_a = 0.0, largest = 0.0;
  for (const UncertaintyShare& share : fit.shares) {
    const double variance = over_sphere(share.covariance);
    if (share.type_a) type_a += variance;
    if (share.type_a || !(variance > largest)) continue;
    largest = variance;
    out.main_type_b = share.source;
  }
  double worst = -1.0;
  for (int k = 0; k < directions; ++k) {
    const Eigen::Matrix<double, 1, 9> j = gradient(fit, direction(k));
    const double variance = (j * fit.covariance * j.transpose()).value();
    if (!(variance > worst)) continue;
    worst = variance;
    out.worst_up = direction(k);
  }
  out.overall_mps2 = std::sqrt(scatter + over_sphere(fit.covariance));
  out.by_noise_mps2 = std::sqrt(scatter + type_a);
  out.worst_mps2 = std::sqrt(scatter + std::max(worst, 0.0));
  return out;
}

}  // namespace proofmass::calibrate
