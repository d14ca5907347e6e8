#pragma once

#include <optional>
#include <vector>

#include "proofmass/calibrate/multi_position.hpp"

namespace proofmass::calibrate {

/// Positions that had no part in a calibration, against it.
struct Validation {
  std::vector<double> residuals_mps2;  ///< |f| − g
  double rms_mps2 = 0.0;
  double expected_rms_mps2 = 0.0;  ///< by the noise of the means and the fit's covariance
  /// Of a mean square so large by chance; absent where nobody knows the noise of the means.
  std::optional<double> p;
};

/// The spread of |f| − g over new positions is what the calibration is good to, whatever its budget
/// says. The p-value takes the new residuals for independent, Σ r²/σ² for chi-square.
/// Source: J. Geist, M. Gaitan, Type-A validation of accelerometer calibrations with local gravity,
/// Metrologia 59 (2022) 052101. Errors: none. poses must not be empty.
[[nodiscard]] Validation validate(const MultiPosition& fit, View<Pose> poses);

}  // namespace proofmass::calibrate
