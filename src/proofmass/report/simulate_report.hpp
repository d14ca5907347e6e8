#pragma once

#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/simulate/rig.hpp"

namespace proofmass::report {

struct SimulateReport {
  std::vector<std::string> inputs;  ///< the rig's description, if it came from a file
  std::string output, truth;        ///< files written
  const simulate::RigOptions& options;
  const simulate::RigResult& result;
};

/// The document of `simulate`: docs/schema/simulate.schema.json.
[[nodiscard]] std::string simulate_json(const SimulateReport& report);

/// A few lines for a terminal: what was simulated and where it lies.
[[nodiscard]] std::string simulate_text(const SimulateReport& report);

}  // namespace proofmass::report
