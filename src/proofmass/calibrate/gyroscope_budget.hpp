#pragma once

#include <string_view>
#include <vector>

#include "proofmass/calibrate/gyroscope.hpp"
#include "proofmass/calibrate/uncertainty_budget.hpp"

// Uncertainty budget of a gyroscope's calibration.
namespace proofmass::calibrate {

/// Unit of a parameter for readings in `reading_unit`: "rad/s", "V" or "counts".
[[nodiscard]] std::string gyroscope_unit(std::size_t parameter, std::string_view reading_unit);

/// A budget for each determined parameter, in their order: one line for each share that acts on it.
[[nodiscard]] std::vector<UncertaintyBudget> budget_of(const GyroscopeCalibration& fit,
                                                       std::string_view reading_unit);

}  // namespace proofmass::calibrate
