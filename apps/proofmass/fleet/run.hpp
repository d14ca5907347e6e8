#pragma once

#include "fleet/command.hpp"
#include "proofmass/fleet/fleet_report.hpp"

namespace proofmass::app {

/// The verb for every recording of the manifest, in processes of their own. Ends the process with
/// 130 where it is interrupted, with the tables made of what is done. Throws Failure.
[[nodiscard]] fleet::FleetReport run_fleet(const FleetCommand& command);

}  // namespace proofmass::app
