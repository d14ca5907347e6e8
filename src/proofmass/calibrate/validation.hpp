#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// Residuals of positions that were not part of the calibration.
struct Validation {
  std::vector<double> residuals_mps2;  ///< |f| − g
  double rms_mps2 = 0.0;
  double expected_rms_mps2 = 0.0;  ///< from the noise of the means and the fit's covariance
  /// p-value of the mean square; absent if the noise of the means is unknown.
  std::optional<double> p;
};

/// The spread of |f| − g over new positions is the accuracy of the calibration, whatever its budget
/// states. The p-value assumes independent residuals, Σ r²/σ² chi-square. Source: J. Geist, M.
/// Gaitan, Type-A validation of accelerometer calibrations with local gravity, Metrologia 59 (2022)
/// 052101. Errors: none. poses must not be empty.
[[nodiscard]] Validation validate(const MultiPosition& fit, View<Pose> poses);

}  // namespace proofmass::calibrate
