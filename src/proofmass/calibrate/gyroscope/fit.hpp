#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/gyroscope/data.hpp"
#include "proofmass/calibrate/gyroscope/rests.hpp"
#include "proofmass/calibrate/multi_position/pose_selection.hpp"

// The matrix A of ω = A (reading − bias − G f) from motions and turntable rates.
namespace proofmass::calibrate {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Residuals and derivatives at one A. Rows: two for each motion used, about axes perpendicular to
/// gravity, in rad; then one for each turntable rate, in rad/s. The parameters are A/size, row by
/// row: relative errors and angles.
struct MatrixEquations {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_matrix;       ///< rows × 9, per relative A
  Eigen::MatrixXd by_offset;       ///< rows × 12, per bias, then G row by row
  Eigen::MatrixXd by_accel;        ///< rows × 9, per parameter of the accelerometer
  Eigen::MatrixXd covariance;      ///< of the residuals due to noise: adjacent motions share a rest
  std::vector<double> turned_rad;  ///< of each motion used
  double size = 1.0;               ///< of A: (rad/s) per reading
};

struct MatrixFit {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  std::vector<bool> used;     ///< of data.motions
  MatrixEquations equations;  ///< at A, of the motions used
  Eigen::MatrixXd weights;    ///< inverse of their covariance
  Matrix9 cofactor;           ///< of relative A, in the subspace that is determined
  Matrix9 undetermined;       ///< projector on the rest
  Scatter scatter;
  /// Deletion residuals of the motions used, by closed form.
  std::vector<std::optional<double>> leave_one_out_rad, studentised;
  int iterations = 0;
  bool converged = false;
};

/// Gauss–Newton from `start`; then the motion with the largest deletion residual is excluded, if
/// significant, and the fit repeated. Source: R. D. Cook, S. Weisberg, Residuals and Influence in
/// Regression (1982), section 2.2 (deletion of rows in closed form).
[[nodiscard]] MatrixFit fit_matrix(const GyroscopeData& data,
                                   const RestRegression& rests,
                                   const Eigen::Matrix3d& start);

/// An initial matrix: signed permutations of the axes with a common scale, by the median angle
/// between gravity as rotated and as measured. `in_radps`: the scale is 1.
/// Errors: not_observable (none explains the motions), invalid_argument (left-handed axes).
[[nodiscard]] Result<Eigen::Matrix3d> starting_matrix(const GyroscopeData& data, bool in_radps);

}  // namespace proofmass::calibrate
