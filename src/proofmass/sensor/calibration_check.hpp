#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/sensor/calibration_update.hpp"

// Whether a measured calibration can be one.
namespace proofmass::sensor {

/// The nine figures in the order of the covariance, and what they are called.
[[nodiscard]] std::array<std::optional<Uncertain>, 9> nine_measured(
    const MeasuredCalibration& measured);
inline constexpr std::array<std::string_view, 9> nine_names{
    "bias x",  "bias y",          "bias z",          "scale x",        "scale y",
    "scale z", "misalignment yz", "misalignment zy", "misalignment zx"};

/// That something was measured, numbers are finite, standard deviations not negative, and the
/// covariance, if there is one, symmetric, without a negative variance, and that of the standard
/// deviations. Errors: invalid_argument, not_finite.
[[nodiscard]] Status check_measured(const MeasuredCalibration& measured);

}  // namespace proofmass::sensor
