#pragma once

#include "proofmass/report/calibrate_report.hpp"
#include "proofmass/report/json.hpp"

// The larger parts of the document of `calibrate`.
namespace proofmass::report {

/// One object a position.
[[nodiscard]] Array positions_json(const CalibrateReport& report);

/// One object a figure, with a line for each source of uncertainty.
[[nodiscard]] Array budgets_json(const CalibrateReport& report);

/// What the draws say of the budgets, or null.
[[nodiscard]] Value monte_carlo_json(const CalibrateReport& report);

/// The calibrations at several supplies and what bias and scale have to do with them.
[[nodiscard]] Object supply_json(const CalibrateReport& report);

}  // namespace proofmass::report
