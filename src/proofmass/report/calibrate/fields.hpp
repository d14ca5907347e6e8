#pragma once

#include "proofmass/report/calibrate/report.hpp"

// Entries of the document of `calibrate`.
namespace proofmass::report {

/// Reason for an absent standard deviation that depends on the noise of the means.
inline constexpr const char* noise_of_means_unknown = "the noise of the means is not known";

/// Origin and number of each file's positions.
[[nodiscard]] Field pose_files_field(const CalibrateReport& report);
[[nodiscard]] Field positions_field(const CalibrateReport& report);

/// Budget of each figure, its Monte Carlo check, bias stability, residuals of new positions.
[[nodiscard]] Field budgets_field(const std::vector<calibrate::UncertaintyBudget>& budgets);
[[nodiscard]] Field monte_carlo_field(const CalibrateReport& report);
[[nodiscard]] Field stability_field(const CalibrateReport& report);
/// Precondition: the report has a validation.
[[nodiscard]] Field validation_field(const CalibrateReport& report);

/// Precondition: the report has a fit against the supply.
[[nodiscard]] Field supply_field(const CalibrateReport& report);

}  // namespace proofmass::report
