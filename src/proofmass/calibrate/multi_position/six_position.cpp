#include "proofmass/calibrate/multi_position/six_position.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "proofmass/calibrate/multi_position/parts.hpp"

namespace proofmass::calibrate {
namespace {

// One side up: the mean of its poses.
struct Side {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double count = 0.0;
};

constexpr std::array<std::string_view, 6> side_names{"+x", "-x", "+y", "-y", "+z", "-z"};

// +x, −x, +y, … for the direction that is an axis within some 25 degrees.
std::optional<std::size_t> side_of(const Pose& pose) {
  if (!pose.up) return std::nullopt;
  Eigen::Index axis = 0;
  if (!(pose.up->cwiseAbs().maxCoeff(&axis) > 0.9)) return std::nullopt;
  return static_cast<std::size_t>(2 * axis + ((*pose.up)(axis) < 0.0 ? 1 : 0));
}

Result<std::array<Side, 6>> sides_of(View<Pose> poses) {
  std::array<Side, 6> sides;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::optional<std::size_t> side = side_of(poses[k]);
    if (!side) {
      return Error{
          Errc::invalid_argument,
          fmt::format("position {}: six positions need a direction along an axis for each: "
                      "+x, -x, +y, -y, +z, -z",
                      k + 1)};
    }
    sides[*side].mean += poses[k].mean;
    sides[*side].covariance += poses[k].mean_covariance;
    sides[*side].count += 1.0;
  }
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (sides[k].count == 0.0) {
      return Error{
          Errc::invalid_argument,
          fmt::format("no position with {} up: six positions need all six", side_names[k])};
    }
    sides[k].mean /= sides[k].count;
    sides[k].covariance /= sides[k].count * sides[k].count;
  }
  return sides;
}

// Contributions of the noise of the means, and of the placement assumed exact; `across` is each
// row's squared part across its axis over the whole.
std::vector<UncertaintyShare> shares_of_sides(const std::array<Side, 6>& sides,
                                              const Parameters& estimate,
                                              const Eigen::Vector3d& across,
                                              double noise_dof,
                                              const MultiPositionOptions& options) {
  UncertaintyShare noise{"noise of the means", true, ParameterMatrix::Zero(), noise_dof};
  UncertaintyShare placement{"placement", false, ParameterMatrix::Zero(), 0.0};
  const double tilt = options.placement_std_rad * options.placement_std_rad;
  const double skew = options.orthogonality_std_rad * options.orthogonality_std_rad;
  const double g = options.gravity_mps2;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto side = static_cast<std::size_t>(2 * k);
    const double variance = sides[side].covariance(k, k) + sides[side + 1].covariance(k, k);
    const double scale = estimate(3 + k);
    noise.covariance(k, k) = variance / 4.0;
    noise.covariance(3 + k, 3 + k) = variance / (4.0 * g * g);
    placement.covariance(k, k) = tilt * (tilt / 2.0 + skew) * scale * scale * g * g;
    placement.covariance(3 + k, 3 + k) =
        ((tilt + skew) * (tilt + skew) + across(k) * (tilt / 2.0 + skew)) * scale * scale;
    placement.covariance(6 + k, 6 + k) = tilt + skew;
  }
  std::vector<UncertaintyShare> shares{placement, gravity_share(estimate, options)};
  if (noise_dof > 0.0) shares.insert(shares.begin(), noise);
  return shares;
}

void add_residuals(View<Pose> poses, bool noise_known, MultiPosition& out) {
  const Eigen::Map<const Parameters> p(out.estimate.data());
  for (const Pose& pose : poses) {
    PoseResidual& residual = out.poses.emplace_back();
    const NormTerm term = norm_term(p, {pose.mean, pose.mean_covariance});
    residual.force_mps2 = term.force;
    residual.residual_mps2 = term.force.norm() - out.gravity_mps2;
    if (noise_known) residual.predicted_std_mps2 = std::sqrt(term.variance);
  }
}

}  // namespace

Result<MultiPosition> calibrate_six_position(View<Pose> poses,
                                             double noise_dof,
                                             const MultiPositionOptions& options) {
  const Result<std::array<Side, 6>> sides = sides_of(poses);
  if (!sides) return sides.error();
  Eigen::Matrix3d U;
  Parameters estimate = Parameters::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Side &up = (*sides)[static_cast<std::size_t>(2 * k)],
               &down = (*sides)[static_cast<std::size_t>(2 * k + 1)];
    U.col(k) = up.mean - down.mean;
    estimate(k) = (up.mean(k) + down.mean(k)) / 2.0;
  }
  estimate.segment<3>(3) = U.rowwise().norm() / (2.0 * options.gravity_mps2);
  if (!(estimate.segment<3>(3).minCoeff() > 0.0)) {
    return Error{Errc::not_observable,
                 "an axis reads the same in all six positions: is it the right channel?"};
  }
  MultiPosition out;
  out.model = PoseModel::six_position;
  out.gravity_mps2 = options.gravity_mps2;
  const Eigen::Vector3d along = U.diagonal().cwiseQuotient(U.rowwise().norm());
  const Eigen::Vector3d across = Eigen::Vector3d::Ones() - along.cwiseAbs2();
  out.shares = shares_of_sides(*sides, estimate, across, noise_dof, options);
  set_estimate(estimate, false, out);
  out.dof = noise_dof;
  out.axes_in_fixture = U.rowwise().normalized();
  out.converged = true;
  add_residuals(poses, noise_dof > 0.0, out);
  set_residual_sums(out);
  if (noise_dof == 0.0) out.notes.emplace_back(noise_missing);
  out.notes.emplace_back(
      "misalignment_rad: null: six positions assumed exact do not separate it from the "
      "sensor's placement; use 12 or more free positions instead");
  out.notes.emplace_back(
      "lack_of_fit: null: six positions assumed exact leave no redundancy to test");
  return out;
}

}  // namespace proofmass::calibrate
