#pragma once

#include "proofmass/report/calibrate_report.hpp"

// Entries of the document of `calibrate`.
namespace proofmass::report {

/// The reason where a standard deviation needs the noise of the means.
inline constexpr const char* noise_of_means_unknown = "the noise of the means is not known";

/// How the positions of each file were given, and how many.
[[nodiscard]] Field pose_files_field(const CalibrateReport& report);
[[nodiscard]] Field positions_field(const CalibrateReport& report);

/// The budget of each figure, its check by Monte Carlo, the drift of the bias, new positions.
[[nodiscard]] Field budgets_field(const std::vector<calibrate::UncertaintyBudget>& budgets);
[[nodiscard]] Field monte_carlo_field(const CalibrateReport& report);
[[nodiscard]] Field stability_field(const CalibrateReport& report);
/// There must be a validation.
[[nodiscard]] Field validation_field(const CalibrateReport& report);

/// There must be a dependence on the supply.
[[nodiscard]] Field supply_field(const CalibrateReport& report);

}  // namespace proofmass::report
