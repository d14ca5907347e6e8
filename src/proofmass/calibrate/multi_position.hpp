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

/// What is taken for known.
enum class PoseModel {
  norm_9,        ///< |f| = g in every pose: bias, scale, misalignment
  norm_6,        ///< the same with axes taken for orthogonal: bias, scale
  given_12,      ///< directions in the fixture's frame are given, its mounting is fitted too
  six_position,  ///< the six directions ±x, ±y, ±z are taken for exact (Ferraris)
};

struct MultiPositionOptions {
  std::optional<PoseModel> model = {};  ///< absent: norm_9, or norm_6 where the poses carry no more
  double gravity_mps2;
  double gravity_std_mps2 = 0.0;
  /// Of the means' covariances' common factor: how well the noise is known; 0: not at all.
  double noise_dof = 0.0;
  /// Of each axis, the covariance between the means of different poses, in the reading's unit
  /// squared, by a bias that wanders (see session_noise.hpp); empty: they are independent. What
  /// norm_9 and norm_6 make use of.
  std::array<Eigen::MatrixXd, 3> between = {};
  /// Standard deviation of each misalignment angle where the model leaves them out.
  double orthogonality_std_rad = 0.01;
  /// Standard deviation of a position's tilt about either axis where six_position takes it for
  /// exact.
  double placement_std_rad = rad_per_deg;
  bool keep_suspects = false;  ///< poses that contradict the others stay in the fit
};

/// One pose against the fit.
struct PoseResidual {
  double residual_mps2 = 0.0;       ///< |f| − g
  double predicted_std_mps2 = 0.0;  ///< of the residual by the noise of the mean, 0 if unknown
  /// |f| − g by a fit to the other poses; absent where those do not carry the parameters.
  std::optional<double> leave_one_out_mps2;
  std::optional<double> studentised;  ///< leave_one_out over its standard deviation
  /// The least error of |f| in this position that would be noticed; absent where none would.
  std::optional<double> detectable_mps2;
  bool suspect = false;  ///< it contradicts the others
  bool used = true;      ///< suspects are left out, unless they are kept
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();  ///< calibrated, in the sensor's axes
};

/// Does noise alone explain the residuals?
struct LackOfFit {
  double statistic = 0.0;  ///< F: mean square of the residuals over that of the noise
  double p = 1.0;          ///< of so much or more by chance
  double dof = 0.0;        ///< poses less parameters, or what given directions leave of it
};

/// The position that would add most to what is known.
struct NextPose {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< unit vector in the sensor's axes
  std::string words;                             ///< "stand it on the edge between …"
  double gain = 0.0;  ///< by which fraction the least certain figure's std would shrink
};

/// Where the uncertainty comes from: a share of the covariance, in the order of
/// MultiPosition::covariance.
struct UncertaintyShare {
  std::string source;  ///< "noise of the means", "resolution of the readings", "gravity" …
  bool type_a = true;
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  double dof = 0.0;  ///< 0: known for certain (infinitely many)
};

struct MultiPosition {
  PoseModel model = PoseModel::norm_9;
  std::array<std::optional<Uncertain>, 3> bias;              ///< unit of the reading
  std::array<std::optional<Uncertain>, 3> scale;             ///< unit of the reading per m/s^2
  std::array<std::optional<Uncertain>, 3> misalignment_rad;  ///< α_yz, α_zy, α_zx
  std::array<double, 9> estimate{};  ///< bias, scale, misalignment; 0 where not estimated
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  std::vector<UncertaintyShare> shares;  ///< their sum is the covariance
  double dof = 0.0;                      ///< of type A, for Student's t; 0: noise is not known
  double gravity_mps2 = 0.0;
  std::vector<PoseResidual> poses;  ///< one for each pose given
  double residual_rms_mps2 = 0.0;   ///< of the poses that were used
  std::optional<double> leave_one_out_rms_mps2;
  std::optional<LackOfFit> lack_of_fit;  ///< absent where noise or redundancy is missing
  double condition = 0.0;                ///< of the weighted Jacobian, columns of unit length
  std::optional<NextPose> next_pose;
  /// Poses of which one contradicts the others, but which one cannot be told.
  std::vector<std::size_t> doubtful;
  /// given_12: turns the fixture's frame into the sensor's, as a rotation vector, and its std.
  std::optional<Eigen::Vector3d> mounting_rad, mounting_std_rad;
  std::optional<double> placement_std_rad;  ///< given_12: how well the positions were set
  /// given_12, six_position: row k is the direction of the sensor's axis k in the fixture's frame.
  std::optional<Eigen::Matrix3d> axes_in_fixture;
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> notes;  ///< sentences for the user
};

/// Whether lengths of the means in m/s^2 can be gravity: half of them within a quarter of it, or
/// else neither 1 (gravity in g) nor g² (gravity in m/s² taken for g).
/// Errors: invalid_argument, with the unit to give.
[[nodiscard]] Status check_acceleration_unit(View<Pose> poses, double gravity_mps2);

/// Fits
///
///     f = T diag(1/scale) (mean − bias),   T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1],   |f| = g,
///
/// to poses at rest, |f| = g in each; a pose that contradicts the others is left out.
///
/// Errors: too_few_samples (fewer poses than parameters), not_observable (the poses do not carry
/// the parameters; the message says which and what to add), not_finite, invalid_argument.
[[nodiscard]] Result<MultiPosition> calibrate_positions(View<Pose> poses,
                                                        const MultiPositionOptions& options);

}  // namespace proofmass::calibrate
