#pragma once

#include <string>
#include <vector>

#include "proofmass/simulate/procedure.hpp"

namespace proofmass::report {

struct ProcedureReport {
  std::vector<std::string> inputs{};      ///< the description, if it came from a file
  std::string output, truth{}, sensor{};  ///< files written
  const simulate::ProcedureOptions& options;
  const simulate::ProcedureResult& result;
};

/// The document of `simulate --procedure`: docs/schema/simulate.schema.json.
[[nodiscard]] std::string procedure_json(const ProcedureReport& report);

/// A few lines for a terminal: what was simulated, where it lies and what the true sensor is.
[[nodiscard]] std::string procedure_text(const ProcedureReport& report);

}  // namespace proofmass::report
