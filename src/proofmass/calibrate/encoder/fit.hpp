#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proofmass/calibrate/encoder.hpp"

// The joint fit of encoder and accelerometers.
namespace proofmass::calibrate {

/// Parameters common to all axes, then the lever arm of each sensor, then those of each axis.
namespace encoder {
inline constexpr Eigen::Index errors = 0;  // c1 s1 … c4 s4
inline constexpr Eigen::Index delay = encoder_parameters, runout = delay + 1, common = runout + 4;
/// Parameters of an axis, relative to axis().
inline constexpr Eigen::Index sin = 0, cos = 1, nonlinear = 2, nonlinear_terms = 7,
                              drift = nonlinear + nonlinear_terms, drift_terms = 4,
                              each = drift + drift_terms;
/// The parameters on which one axis depends: the common ones, its sensor's lever arm, its own.
inline constexpr Eigen::Index seen = common + 2 + each;

struct Layout {
  std::size_t sensors = 0, axes = 0;
  std::vector<std::size_t> sensor_of;  ///< of each axis

  [[nodiscard]] Eigen::Index lever(std::size_t sensor) const {
    return common + 2 * static_cast<Eigen::Index>(sensor);
  }
  [[nodiscard]] Eigen::Index axis(std::size_t at) const {
    return lever(sensors) + each * static_cast<Eigen::Index>(at);
  }
  [[nodiscard]] Eigen::Index count() const { return axis(axes); }
};
[[nodiscard]] Layout layout_of(const EncoderRecording& recording);

using Seen = Eigen::Matrix<double, seen, 1>;
/// The parameters that an axis sees.
[[nodiscard]] Seen seen_by(const Eigen::VectorXd& parameters,
                           const Layout& layout,
                           std::size_t axis);
}  // namespace encoder

/// Motion that the encoder shows, at each row.
struct EncoderMotion {
  signal::AngleMotion at;
  std::vector<double> jerk_radps3;
};

/// Rows of the recording in which the wheel turns, with the motion that the encoder shows there.
struct EncoderRows {
  std::vector<std::size_t> row;
  std::vector<double> time_s, phase;  ///< phase: −1 … 1 over the recording
  EncoderMotion shown;
  /// The same, smoothed over a quarter of a turn to either side: a three-hundredth of the variance
  /// of the acceleration.
  EncoderMotion smooth;
  std::vector<std::size_t> block;  ///< of whole turns
  std::size_t blocks = 0;
};

struct EncoderFit {
  Eigen::VectorXd parameters, prior_std;
  Eigen::MatrixXd inverse;       ///< H⁻¹, not symmetric
  Eigen::MatrixXd type_a;        ///< H⁻¹ M H⁻ᵀ
  std::vector<double> variance;  ///< of each axis
  int iterations = 0;
  bool converged = false;
};

/// The wheel's motion, from that of the encoder and its errors.
struct WheelPoint {
  double angle = 0.0, speed = 0.0, accel = 0.0, jerk = 0.0;
};
[[nodiscard]] WheelPoint true_point(const Eigen::VectorXd& parameters,
                                    double shown_rad,
                                    double shown_radps,
                                    double shown_radps2);

/// Output of one axis at one row, and its derivatives by the wheel's angle and by the parameters
/// that it sees.
struct AxisPrediction {
  double value = 0.0, by_angle = 0.0;
  encoder::Seen h;
};
[[nodiscard]] AxisPrediction predict_axis(const encoder::Seen& parameters,
                                          const WheelPoint& wheel,
                                          double phase,
                                          double gravity_mps2);

/// Gauss–Newton with the priors, weights by the residuals of each axis; then instrumental
/// variables: Σ h̃ᵢ rᵢ/σᵢ² = 0 with h̃ the derivatives at the smooth motion. The noise of the
/// encoder's acceleration, times a lever arm, is in the residuals as well as in their derivatives
/// h; its variance in h r would bias lever arm, delay and harmonics. Where that does not converge,
/// or leaves much larger residuals, least squares give the result. Source: W. A. Fuller,
/// Measurement Error Models (1987), section 1.4. `from`: a fit to other rows of the recording, to
/// start from.
[[nodiscard]] EncoderFit fit_encoder(const EncoderRecording& recording,
                                     const EncoderRows& rows,
                                     const EncoderOptions& options,
                                     const std::optional<EncoderFit>& from);

/// Σ ln of the variances of the axes' residuals.
[[nodiscard]] double log_variance(const EncoderFit& fit);

/// ψ less the θ that the accelerometers show, in bins of a sixteenth of a turn.
struct EncoderOffsets {
  std::vector<double> time_s, angle_rad, offset_rad, fitted_rad;
  std::vector<double> speed_radps;
};
[[nodiscard]] EncoderOffsets offsets_of(const EncoderRecording& recording,
                                        const EncoderRows& rows,
                                        const EncoderFit& fit,
                                        double gravity_mps2);

}  // namespace proofmass::calibrate
