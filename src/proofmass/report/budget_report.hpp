#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/estimate/position_budget.hpp"

namespace proofmass::report {

struct BudgetReport {
  std::vector<std::string> inputs;  ///< sensor files, if any
  std::vector<Note> notes;
  std::vector<estimate::BudgetRow> rows;
};

/// The document of `budget`: docs/schema/budget.schema.json.
[[nodiscard]] std::string budget_json(const BudgetReport& report);

/// Error against time, both axes logarithmic, and the table.
[[nodiscard]] std::string budget_html(const BudgetReport& report);

/// The table for a terminal.
[[nodiscard]] std::string budget_text(const BudgetReport& report);

}  // namespace proofmass::report
