#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/calibration_update.hpp"

// Validity checks of a measured calibration.
namespace proofmass::sensor {

/// The nine figures in the order of the covariance, and their names.
[[nodiscard]] std::array<std::optional<Uncertain>, 9> nine_measured(
    const MeasuredCalibration& measured);
inline constexpr std::array<std::string_view, 9> nine_names{
    "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
    "scale z", "misalignment yz", "misalignment zy", "misalignment zx"};

/// Checks that something was measured, that numbers are finite, that standard deviations are not
/// negative, and that the covariance, if present, is symmetric, positive semidefinite and
/// consistent with the standard deviations. Errors: invalid_argument, not_finite.
[[nodiscard]] Status check_measured(const MeasuredCalibration& measured);

}  // namespace proofmass::sensor
