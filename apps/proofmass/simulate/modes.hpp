#pragma once

#include <string>

#include "simulate/command.hpp"

namespace proofmass::app {

/// `simulate --procedure NAME`. Throws Failure.
void run_procedure(const SimulateCommand& command);

/// The truth's file beside a recording's: "rig.csv" → "rig.truth.csv".
[[nodiscard]] std::string truth_name(const std::string& file);

}  // namespace proofmass::app
