#pragma once

#include "fleet/command.hpp"
#include "proofmass/fleet/fleet_report.hpp"

namespace proofmass::app {

/// Runs the verb on each recording of the manifest, each in its own process. If interrupted, writes
/// the tables of the completed jobs and ends the process with 130. Throws Failure.
[[nodiscard]] fleet::FleetReport run_fleet(const FleetCommand& command);

}  // namespace proofmass::app
