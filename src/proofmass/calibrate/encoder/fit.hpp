#pragma once

#include <Eigen/Core>
#include <vector>

#include "proofmass/calibrate/encoder.hpp"

// The joint fit of encoder and accelerometers.
namespace proofmass::calibrate {

/// Parameters common to all axes, then those of each axis.
namespace encoder {
inline constexpr Eigen::Index errors = 0;  // c1 s1 … c4 s4
inline constexpr Eigen::Index delay = encoder_parameters, runout = delay + 1, common = runout + 4;
inline constexpr Eigen::Index sin = 0, cos = 1, by_speed2 = 2, by_accel = 3, nonlinear = 4,
                              drift = 8, drift_terms = 4, each = drift + drift_terms;
[[nodiscard]] constexpr Eigen::Index axis(std::size_t at) {
  return common + each * static_cast<Eigen::Index>(at);
}
}  // namespace encoder

/// Rows of the recording in which the wheel turns, with the motion that the encoder shows there.
struct EncoderRows {
  std::vector<std::size_t> row;
  std::vector<double> time_s, phase;  ///< phase: −1 … 1 over the recording
  signal::AngleMotion shown;
  std::vector<std::size_t> block;  ///< of whole turns
  std::size_t blocks = 0;
};

struct EncoderFit {
  Eigen::VectorXd parameters, prior_std;
  Eigen::MatrixXd inverse;     ///< H⁻¹
  Eigen::MatrixXd type_a;      ///< H⁻¹ M H⁻¹
  std::vector<double> variance;  ///< of each axis
  int iterations = 0;
  bool converged = false;
};

/// The wheel's motion, from that of the encoder and its errors.
struct WheelPoint {
  double angle = 0.0, speed = 0.0, accel = 0.0;
};
[[nodiscard]] WheelPoint true_point(const Eigen::VectorXd& parameters,
                                    double shown_rad,
                                    double shown_radps,
                                    double shown_radps2);

/// Output of one axis at one row, and its derivatives by the common parameters (h_common) and the
/// axis's own (h_axis).
struct AxisPrediction {
  double value = 0.0, by_angle = 0.0;
  Eigen::Matrix<double, encoder::common, 1> h_common;
  Eigen::Matrix<double, encoder::each, 1> h_axis;
};
[[nodiscard]] AxisPrediction predict_axis(const Eigen::VectorXd& parameters,
                                          const WheelPoint& wheel,
                                          std::size_t axis,
                                          double phase,
                                          double gravity_mps2);

/// Gauss–Newton with the priors, weights by the residuals of each axis.
[[nodiscard]] EncoderFit fit_encoder(const EncoderRecording& recording,
                                     const EncoderRows& rows,
                                     const EncoderOptions& options,
                                     Eigen::VectorXd start);

/// ψ less the θ that the accelerometers show, in bins of a sixteenth of a turn.
struct EncoderOffsets {
  std::vector<double> time_s, angle_rad, offset_rad, fitted_rad;
};
[[nodiscard]] EncoderOffsets offsets_of(const EncoderRecording& recording,
                                        const EncoderRows& rows,
                                        const EncoderFit& fit,
                                        double gravity_mps2);

}  // namespace proofmass::calibrate
