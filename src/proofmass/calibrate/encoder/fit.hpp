#pragma once

#include <Eigen/Core>
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

/// Rows of the recording in which the wheel turns, with the motion that the encoder shows there.
struct EncoderRows {
  std::vector<std::size_t> row;
  std::vector<double> time_s, phase;  ///< phase: −1 … 1 over the recording
  signal::AngleMotion shown;
  std::vector<double> jerk_radps3;
  std::vector<std::size_t> block;  ///< of whole turns
  std::size_t blocks = 0;
};

struct EncoderFit {
  Eigen::VectorXd parameters, prior_std;
  Eigen::MatrixXd inverse;       ///< H⁻¹
  Eigen::MatrixXd type_a;        ///< H⁻¹ M H⁻¹
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

/// Gauss–Newton with the priors, weights by the residuals of each axis.
[[nodiscard]] EncoderFit fit_encoder(const EncoderRecording& recording,
                                     const EncoderRows& rows,
                                     const EncoderOptions& options);

/// ψ less the θ that the accelerometers show, in bins of a sixteenth of a turn.
struct EncoderOffsets {
  std::vector<double> time_s, angle_rad, offset_rad, fitted_rad;
};
[[nodiscard]] EncoderOffsets offsets_of(const EncoderRecording& recording,
                                        const EncoderRows& rows,
                                        const EncoderFit& fit,
                                        double gravity_mps2);

}  // namespace proofmass::calibrate
