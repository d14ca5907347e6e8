#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/view.hpp"

// |f| = g, in numbers of the size of one: readings of 33 000 counts and scales of 414 counts per
// m/s² do not meet in one vector.
namespace proofmass::calibrate {

/// Bias x y z, scale x y z, misalignment α_yz, α_zy, α_zx.
using Parameters = Eigen::Matrix<double, 9, 1>;
using ParameterMatrix = Eigen::Matrix<double, 9, 9>;

/// reading = center + half · u on each axis; force in units of g.
struct ReadingScale {
  Eigen::Vector3d center, half;
  double gravity_mps2;

  /// From u and g to the reading's unit and m/s^2: the diagonal of d(parameters)/d(normalised).
  [[nodiscard]] Parameters slope() const;
  [[nodiscard]] Parameters to_reading(const Parameters& normalised) const;
};

/// A pose as the fit sees it.
struct NormalisedPose {
  Eigen::Vector3d u;
  Eigen::Matrix3d covariance;  ///< of u, by noise
};

/// All poses of a fit.
struct NormData {
  std::vector<NormalisedPose> poses;
  /// Of each axis, the covariance of u between different poses, by a bias that wanders from one to
  /// the next; empty: there is none. The diagonal is not read.
  std::array<Eigen::MatrixXd, 3> between = {};

  [[nodiscard]] bool independent() const { return between[0].size() == 0; }
};

/// Midrange and half range of the means. nullopt if no axis reads two different values.
[[nodiscard]] std::optional<ReadingScale> reading_scale(View<Pose> poses, double gravity_mps2);

[[nodiscard]] std::vector<NormalisedPose> normalise(View<Pose> poses, const ReadingScale& scale);

/// T diag(1/scale), T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1].
[[nodiscard]] Eigen::Matrix3d correction(const Parameters& p);

/// |f| − 1 of one pose with its derivatives, f = T diag(1/scale) (u − bias).
struct NormTerm {
  Eigen::Vector3d force;
  double residual;
  Eigen::Matrix<double, 1, 9> gradient;
  double variance;  ///< of the residual by noise: nᵀ M Σ Mᵀ n, n = f/|f|
};

/// NaN where the force is zero.
[[nodiscard]] NormTerm norm_term(const Parameters& p, const NormalisedPose& pose);

/// W, the inverse of the residuals' covariance; 0 for poses that are not used.
struct ResidualWeights {
  Eigen::VectorXd diagonal;
  Eigen::MatrixXd dense;  ///< empty: there is nothing beside the diagonal

  [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const;
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& rows) const;
};

/// Of the poses for which `used` holds. Cost: O(n³), O(n) where they are independent.
[[nodiscard]] ResidualWeights residual_weights(const NormData& data,
                                               const std::vector<NormTerm>& terms,
                                               const std::vector<bool>& used);

}  // namespace proofmass::calibrate
