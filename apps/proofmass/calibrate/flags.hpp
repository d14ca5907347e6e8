#pragma once

#include <CLI/CLI.hpp>

#include "calibrate/command.hpp"

namespace proofmass::app {

void add_calibrate_flags(CLI::App& verb, CalibrateCommand& command);

/// Throws Failure if flags contradict each other.
void expect_sense(const CalibrateCommand& command);

}  // namespace proofmass::app
