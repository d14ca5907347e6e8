#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"
#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Bias, scale, misalignment, alignment and g-sensitivity of a three-axis gyroscope from a recording
// that calibrates the accelerometer beside it: static positions with rotations between them.
namespace proofmass::calibrate {

/// One recording of both sensors on one time base.
struct GyroscopeSession {
  std::vector<double> time_s;                ///< of each sample, increasing
  std::array<std::vector<double>, 3> rate;   ///< gyroscope x, y, z: rad/s, V or counts
  std::array<std::vector<double>, 3> accel;  ///< accelerometer, in the unit of its calibration
  std::vector<Dwell> rests;                  ///< static intervals, in order
  std::vector<Pose> poses;                   ///< the accelerometer's means over them
  double pose_noise_dof = 0.0;               ///< PoseMeans::noise_dof of the poses
  std::array<double, 3> rate_lsb{};          ///< quantisation step of the gyroscope, 0: none
};

/// A turntable's steady rotation about one fixed axis. Only the magnitude of its rate is used, so
/// the orientation of the sensor on the table need not be known.
struct TurntableRate {
  std::size_t session = 0;
  double start_s, end_s;  ///< in the session's time
  double rate_radps;      ///< of either sign
  double std_radps;       ///< standard uncertainty of the rate
};

struct GyroscopeOptions {
  /// The gyroscope's readings are in rad/s, so that its scale factors are near 1. False: the scale
  /// is searched for.
  bool in_radps = true;
  std::optional<double> latitude_rad = {};  ///< for Earth's rotation; absent: unknown
  std::vector<TurntableRate> table = {};
};

/// Parameters in the order of the covariance: bias x y z, scale x y z, misalignment α_yz α_zy α_zx,
/// alignment x y z, then the g-sensitivity G row by row.
inline constexpr std::size_t gyroscope_parameters = 21;
using GyroscopeVector = Eigen::Matrix<double, gyroscope_parameters, 1>;
using GyroscopeMatrix = Eigen::Matrix<double, gyroscope_parameters, gyroscope_parameters>;

/// "bias x" … "scale z", "misalignment yz" …, "alignment x" …, "g-sensitivity xx" … "zz".
[[nodiscard]] const std::array<std::string, gyroscope_parameters>& gyroscope_parameter_names();

/// One rotation between two static positions.
struct MotionResidual {
  std::size_t session = 0, from = 0;  ///< index of the first of the two rests
  double start_s = 0.0, end_s = 0.0;
  double turned_rad = 0.0;                  ///< total angle, ∫ |ω| dt
  double residual_rad = 0.0;                ///< angle from the predicted to the measured gravity
  double predicted_std_rad = 0.0;           ///< root of the mean variance of its two components
  std::optional<double> leave_one_out_rad;  ///< residual by a fit to the other motions
  std::optional<double> studentised;  ///< root of the mean square of both, over their covariance
  bool used = true;
  std::string why_unused;  ///< "contradicts the others", "samples are missing"
};

/// One steady rate of a turntable.
struct RateResidual {
  double rate_radps = 0.0;
  double residual_radps = 0.0;  ///< |ω| less the table's rate
  double predicted_std_radps = 0.0;
};

/// Origin of the uncertainty, in the order of the parameters.
struct GyroscopeShare {
  std::string source;
  bool type_a = true;
  GyroscopeMatrix covariance = GyroscopeMatrix::Zero();
  double dof = 0.0;  ///< 0: infinite
};

struct GyroscopeCalibration {
  GyroscopeVector estimate = GyroscopeVector::Zero();  ///< nominal where not determined
  GyroscopeMatrix covariance = GyroscopeMatrix::Zero();
  std::array<std::string, gyroscope_parameters> why_absent;  ///< empty: it is determined
  std::vector<GyroscopeShare> shares;                        ///< their sum is the covariance
  std::array<double, gyroscope_parameters> dof{};  ///< of type A, for Student's t; 0: infinite
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  ///< R T diag(1/scale)
  std::vector<MotionResidual> motions;
  std::vector<RateResidual> rates;
  double residual_rms_rad = 0.0;  ///< of the motions used
  std::optional<double> leave_one_out_rms_rad;
  std::optional<LackOfFit> lack_of_fit;        ///< of motions and rates
  std::optional<LackOfFit> rests_lack_of_fit;  ///< of the means at rest: drift of the bias
  std::array<double, 3> angle_random_walk{};   ///< N at rest, rad/√s; 0: no noise is visible
  int iterations = 0;
  bool converged = false;
  std::vector<std::string> notes;

  /// Value and standard deviation, absent where not determined.
  [[nodiscard]] std::optional<Uncertain> parameter(std::size_t k) const;
};

/// Fits
///
///     ω = R(ρ) T diag(1/scale) (reading − bias − G f),   T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1],
///
/// with the calibrated specific force f; ω and f are in the accelerometer's frame. T has the form
/// of the accelerometer's, R is the rotation by the vector ρ from the gyroscope's frame to the
/// accelerometer's.
///
/// - Bias and G: weighted regression of the means at rest on f. The bias is that at f = 0, mean
///   over the session.
/// - Matrix: gravity's direction before a motion, rotated by the integrated rate, is compared with
///   that after it. The bias during a motion is the mean of the readings in the two adjacent
///   rests, which removes drift. Generalised least squares: adjacent motions share a rest.
/// - Turntable: |R T diag(1/scale) (mean − bias − G f)| is the table's rate.
/// - A motion that contradicts the others (F-test of its deletion residual, 1 % with Bonferroni's
///   correction) is excluded.
/// - Parameters with a standard deviation above 5 % or 50 mrad are not determined.
///
/// Uncertainty: noise of both sensors by their rests, scatter of the residuals, covariance of the
/// accelerometer's calibration, Earth's rotation.
///
/// Source: D. Tedaldi, A. Pretto, E. Menegatti, A robust and easy to implement method for IMU
/// calibration without external equipments, ICRA 2014, section III (cost function; unweighted
/// there, and without g-sensitivity); integration and weights: docs/methods/gyroscope.md.
///
/// Errors: invalid_argument (a session of unequal lengths, a table's interval outside the
/// recording, axes that form a left-handed system), too_few_samples (fewer than three motions
/// and no rate), not_observable (no matrix explains the motions), those of pose_means().
[[nodiscard]] Result<GyroscopeCalibration> calibrate_gyroscope(
    View<GyroscopeSession> sessions,
    const MultiPosition& accelerometer,
    const GyroscopeOptions& options = {});

}  // namespace proofmass::calibrate
