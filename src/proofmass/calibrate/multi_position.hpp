#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/pose.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/core/view.hpp"

// Bias, scale and misalignment of a three-axis accelerometer from rests in several positions.
namespace proofmass::calibrate {

/// Which quantities are assumed known.
enum class PoseModel {
  norm_9,        ///< |f| = g in every pose: bias, scale, misalignment
  norm_6,        ///< as norm_9 with orthogonal axes: bias, scale
  given_12,      ///< directions in the fixture's frame are given; its mounting is fitted too
  six_position,  ///< the six directions ±x, ±y, ±z are assumed exact (Ferraris)
};

struct MultiPositionOptions {
  /// Absent: norm_9, or norm_6 if the poses do not determine more.
  std::optional<PoseModel> model = {};
  double gravity_mps2;
  double gravity_std_mps2 = 0.0;
  /// Degrees of freedom of the common factor of the means' covariances; 0: unknown.
  double noise_dof = 0.0;
  /// Covariance of each axis between the means of different poses due to bias drift, in the
  /// output's unit squared (see session_noise.hpp); empty: they are independent. Used by norm_9 and
  /// norm_6.
  std::array<Eigen::MatrixXd, 3> between = {};
  /// Standard deviation of each misalignment angle if the model omits them.
  double orthogonality_std_rad = 0.01;
  /// Standard deviation of a position's tilt about either axis if six_position assumes it exact.
  double placement_std_rad = rad_per_deg;
  bool keep_suspects = false;  ///< outlying poses stay in the fit
};

/// Residual of one pose.
struct PoseResidual {
  double residual_mps2 = 0.0;       ///< |f| − g
  double predicted_std_mps2 = 0.0;  ///< of the residual, from the noise of the mean; 0 if unknown
  /// |f| − g by a fit to the other poses; absent if those do not determine the parameters.
  std::optional<double> leave_one_out_mps2;
  std::optional<double> studentised;  ///< leave_one_out over its standard deviation
  /// The smallest detectable error of |f| in this position; absent if none is detectable.
  std::optional<double> detectable_mps2;
  bool suspect = false;                                  ///< outlier
  bool used = true;                                      ///< suspects are excluded, unless kept
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< calibrated, in the sensor's axes
};

/// Test whether noise alone explains the residuals.
struct LackOfFit {
  double statistic = 0.0;  ///< F: mean square of the residuals over that of the noise
  double p = 1.0;          ///< p-value
  double dof = 0.0;  ///< poses minus parameters; with given directions the remaining redundancy
};

/// The most informative next position.
struct NextPose {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< unit vector in the sensor's axes
  std::string words;                             ///< "stand it on the edge between …"
  double gain = 0.0;  ///< relative reduction of the least certain parameter's std
};

/// Origin of the uncertainty: a share of the covariance, in the order of MultiPosition::covariance.
struct UncertaintyShare {
  std::string source;  ///< "noise of the means", "resolution of the readings", "gravity" …
  bool type_a = true;
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  double dof = 0.0;  ///< 0: infinite
};

struct MultiPosition {
  PoseModel model = PoseModel::norm_9;
  std::array<std::optional<Uncertain>, 3> bias;              ///< unit of the output
  std::array<std::optional<Uncertain>, 3> scale;             ///< unit of the output per m/s^2
  std::array<std::optional<Uncertain>, 3> misalignment_rad;  ///< α_yz, α_zy, α_zx
  std::array<double, 9> estimate{};  ///< bias, scale, misalignment; 0 where not estimated
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  std::vector<UncertaintyShare> shares;  ///< their sum is the covariance
  double dof = 0.0;                      ///< of type A, for Student's t; 0: noise is unknown
  double gravity_mps2 = 0.0;
  std::vector<PoseResidual> poses;  ///< one for each pose given
  double residual_rms_mps2 = 0.0;   ///< of the poses used
  std::optional<double> leave_one_out_rms_mps2;
  std::optional<LackOfFit> lack_of_fit;  ///< absent if noise or redundancy is missing
  double condition = 0.0;                ///< of the weighted Jacobian, columns of unit length
  std::optional<NextPose> next_pose;
  /// Poses one of which is an outlier that cannot be identified.
  std::vector<std::size_t> doubtful;
  /// given_12: rotation vector from the fixture's frame to the sensor's, and its std.
  std::optional<Eigen::Vector3d> mounting_rad, mounting_std_rad;
  /// Given_12: standard deviation of the position settings.
  std::optional<double> placement_std_rad;
  /// given_12, six_position: row k is the direction of the sensor's axis k in the fixture's frame.
  std::optional<Eigen::Matrix3d> axes_in_fixture;
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> notes;  ///< sentences for the user
};

/// Whether norms of the means in m/s^2 can be gravity: half of them within a quarter of it, or else
/// neither 1 (gravity in g) nor g² (m/s² misinterpreted as g). Errors: invalid_argument, with the
/// correct unit.
[[nodiscard]] Status check_acceleration_unit(View<Pose> poses, double gravity_mps2);

/// Fits
///
///     f = T diag(1/scale) (mean − bias),   T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1],   |f| = g,
///
/// to poses at rest, |f| = g in each; an outlying pose is excluded.
///
/// Errors: too_few_samples (fewer poses than parameters), not_observable (the poses do not
/// determine the parameters; the message names them and the poses to add), not_finite,
/// invalid_argument.
[[nodiscard]] Result<MultiPosition> calibrate_positions(View<Pose> poses,
                                                        const MultiPositionOptions& options);

}  // namespace proofmass::calibrate
