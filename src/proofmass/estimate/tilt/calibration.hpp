#pragma once

#include <optional>

#include "proofmass/estimate/filter/gaussian.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::estimate {

/// Force uncertainty due to the uncertainty of a calibration,
///
///     f = T u,  u = (reading − bias) / scale:      ∂f/∂bias_i = −T e_i / scale_i,
///     ∂f/∂scale_i = −T e_i u_i / scale_i,   ∂f/∂α_yz = −u_y e_x,  ∂f/∂α_zy = u_z e_x,  ∂f/∂α_zx =
///     −u_z e_y.
///
/// Covariances are the calibration's or, without any, those of independent parameters; with few
/// degrees of freedom they are widened so that 1.96 standard deviations contain 95 % of Student's
/// t. Absent if no parameter has a standard deviation.
class CalibrationSpread {
 public:
  [[nodiscard]] static std::optional<CalibrationSpread> of(const sensor::Calibration& calibration);

  /// (m/s²)², for a force in m/s².
  [[nodiscard]] Mat<3, 3> at(const Mat<3>& force) const;

 private:
  Mat<3, 3> T_ = Mat<3, 3>::Identity();
  Mat<3> scale_ = Mat<3>::Ones();
  Mat<9, 9> cov_ = Mat<9, 9>::Zero();
};

/// Standard deviation of the bias between sessions, rms of the axes that state it; nullopt if none
/// does.
[[nodiscard]] std::optional<double> stability_mps2(const sensor::Calibration& calibration);

}  // namespace proofmass::estimate
