#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/view.hpp"

// |f| = g in normalised units, so that outputs of 33 000 counts and scales of 414 counts per m/s²
// are not in one vector.
namespace proofmass::calibrate {

/// Bias x y z, scale x y z, misalignment α_yz, α_zy, α_zx.
using Parameters = Eigen::Matrix<double, 9, 1>;
using ParameterMatrix = Eigen::Matrix<double, 9, 9>;

/// reading = center + half · u on each axis; force in units of g.
struct ReadingScale {
  Eigen::Vector3d center, half;
  double gravity_mps2;

  /// Diagonal of d(parameters)/d(normalised), from u and g to the output's unit and m/s^2.
  [[nodiscard]] Parameters slope() const;
  [[nodiscard]] Parameters to_reading(const Parameters& normalised) const;
  [[nodiscard]] Parameters to_normalised(const Parameters& reading) const;
  [[nodiscard]] Eigen::Vector3d normalised(const Eigen::Vector3d& reading) const;
};

/// A pose in the units of the fit.
struct NormalisedPose {
  Eigen::Vector3d u;
  Eigen::Matrix3d covariance;  ///< of u, due to noise
};

/// All poses of a fit.
struct NormData {
  std::vector<NormalisedPose> poses;
  /// For each axis, the covariance of u between different poses due to bias drift; empty: none. The
  /// diagonal is not used.
  std::array<Eigen::MatrixXd, 3> between = {};

  [[nodiscard]] bool independent() const { return between[0].size() == 0; }
};

/// Midrange and half range of the means. nullopt if an axis has no two different values.
[[nodiscard]] std::optional<ReadingScale> reading_scale(View<Pose> poses, double gravity_mps2);

[[nodiscard]] std::vector<NormalisedPose> normalise(View<Pose> poses, const ReadingScale& scale);

/// Poses whose variances are the weights of a fit: equal weights if the noise of any is unknown,
/// and then noise_dof is 0.
struct Weighable {
  std::vector<Pose> poses;
  double noise_dof;
};

[[nodiscard]] Weighable weighable(View<Pose> poses, double noise_dof);

/// The input of the fit. The covariances `between` poses are those of the options if the noise is
/// known: known drift with unknown noise would have no scale.
[[nodiscard]] NormData norm_data(const Weighable& weighed,
                                 const ReadingScale& scale,
                                 const MultiPositionOptions& options);

/// T diag(1/scale), T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1].
[[nodiscard]] Eigen::Matrix3d correction(const Parameters& p);

/// |f| − 1 of one pose with its derivatives, f = T diag(1/scale) (u − bias).
struct NormTerm {
  Eigen::Vector3d force;
  double residual;
  Eigen::Matrix<double, 1, 9> gradient;
  double variance;  ///< of the residual, due to noise: nᵀ M Σ Mᵀ n, n = f
};

/// NaN if the force is zero.
[[nodiscard]] NormTerm norm_term(const Parameters& p, const NormalisedPose& pose);

/// W, the inverse of the residuals' covariance; 0 for poses not used.
struct ResidualWeights {
  Eigen::VectorXd diagonal;
  Eigen::MatrixXd dense;  ///< empty: diagonal

  [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const;
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& rows) const;
};

/// Weights of the poses for which `used` holds. Cost: O(n³), O(n) if they are independent.
[[nodiscard]] ResidualWeights residual_weights(const NormData& data,
                                               const std::vector<NormTerm>& terms,
                                               const std::vector<bool>& used);

}  // namespace proofmass::calibrate
