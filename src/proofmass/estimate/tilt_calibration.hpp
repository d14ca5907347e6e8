#pragma once

#include <optional>

#include "proofmass/estimate/gaussian.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::estimate {

/// What the uncertainty of a calibration leaves in the force that it gives,
///
///     f = T u,  u = (reading − bias) / scale:      ∂f/∂bias_i = −T e_i / scale_i,
///     ∂f/∂scale_i = −T e_i u_i / scale_i,   ∂f/∂α_yz = −u_y e_x,  ∂f/∂α_zy = u_z e_x,  ∂f/∂α_zx =
///     −u_z e_y.
///
/// Covariances are its own or, where it has none, those of figures that are independent; with few
/// degrees of freedom they are widened to what holds 95 % of Student's t at 1.96 standard
/// deviations. Absent where no figure has a standard deviation.
class CalibrationSpread {
 public:
  [[nodiscard]] static std::optional<CalibrationSpread> of(const sensor::Calibration& calibration);

  /// (m/s²)², of a force in m/s².
  [[nodiscard]] Mat<3, 3> at(const Mat<3>& force) const;

 private:
  Mat<3, 3> T_ = Mat<3, 3>::Identity();
  Mat<3> scale_ = Mat<3>::Ones();
  Mat<9, 9> cov_ = Mat<9, 9>::Zero();
};

/// Standard deviation of the bias from one session to another, rms of the axes that state it;
/// nullopt where none does.
[[nodiscard]] std::optional<double> stability_mps2(const sensor::Calibration& calibration);

}  // namespace proofmass::estimate
