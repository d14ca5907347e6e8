#pragma once

#include <array>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/sensor/sensor_model.hpp"

namespace proofmass::sensor {

/// True if the gyroscope has a bias or a scale for each axis.
[[nodiscard]] bool is_calibrated(const Gyroscope& gyroscope);

/// The unit of the readings of its calibration: "rad/s", "V" or "counts".
[[nodiscard]] std::string reading_unit(const Gyroscope& gyroscope);

/// R(ρ) T diag(1/scale), row by row; SI. A missing figure counts as scale 1 or angle 0.
[[nodiscard]] std::array<std::array<double, 3>, 3> correction_matrix(const Gyroscope& gyroscope);

/// Applies ω = R(ρ) T diag(1/scale) (reading − bias − G f) to the readings of three axes, in the
/// unit of the calibration, in place. `accel_mps2` is the calibrated specific force of the same
/// samples; empty axes, and samples without a number, leave G f out. Errors: invalid_argument (a
/// scale of 0, axes of different lengths).
[[nodiscard]] Status apply(const Gyroscope& gyroscope,
                           const std::array<std::vector<double>, 3>& accel_mps2,
                           std::array<std::vector<double>, 3>& rates);

}  // namespace proofmass::sensor
