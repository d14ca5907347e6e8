#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "simulate/command.hpp"

namespace proofmass::app {

/// `simulate --procedure NAME`. Throws Failure.
void run_procedure(const SimulateCommand& command);

/// `simulate --procedure motor`. Throws Failure.
void run_motor(const SimulateCommand& command);

/// `simulate --procedure servo`. Throws Failure.
void run_servo(const SimulateCommand& command);

/// Throws Failure for a flag that motor and servo have not, nor what `also` names.
void refuse_other_flags(const SimulateCommand& command,
                        std::initializer_list<std::string_view> also);

/// File of the true values beside a recording: "rig.csv" → "rig.truth.csv".
[[nodiscard]] std::string truth_name(const std::string& file);

}  // namespace proofmass::app
