#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/position_budget.hpp"
#include "proofmass/report/document.hpp"

namespace proofmass::report {

struct BudgetReport {
  std::vector<std::string> inputs;  ///< sensor files, if any
  std::vector<Note> notes;
  std::vector<estimate::BudgetRow> rows;
};

/// Position error against time, as a table and as a figure. Holds a reference to the report, which
/// must outlive it.
[[nodiscard]] Document describe(const BudgetReport& report);

}  // namespace proofmass::report
