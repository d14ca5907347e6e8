#pragma once

#include <string>

#include "simulate/command.hpp"

namespace proofmass::app {

/// `simulate --procedure NAME`. Throws Failure.
void run_procedure(const SimulateCommand& command);

/// `simulate --procedure motor`. Throws Failure.
void run_motor(const SimulateCommand& command);

/// File of the true values beside a recording: "rig.csv" → "rig.truth.csv".
[[nodiscard]] std::string truth_name(const std::string& file);

}  // namespace proofmass::app
