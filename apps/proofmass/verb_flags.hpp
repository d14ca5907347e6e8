#pragma once

#include <CLI/CLI.hpp>

#include "command_line.hpp"

// Each verb with its flags.
namespace proofmass::app {

void add_flags(CLI::App& app, InspectCommand& command);
void add_flags(CLI::App& app, ConvertCommand& command);
void add_flags(CLI::App& app, WheelCommand& command);
void add_flags(CLI::App& app, NoiseCommand& command);
void add_flags(CLI::App& app, DriftCommand& command);
void add_flags(CLI::App& app, CalibrateCommand& command);
void add_flags(CLI::App& app, TumbleCommand& command);
void add_flags(CLI::App& app, TiltCommand& command);
void add_flags(CLI::App& app, TrackCommand& command);
void add_flags(CLI::App& app, TuneCommand& command);
void add_flags(CLI::App& app, SensorCommand& command);
void add_flags(CLI::App& app, SimulateCommand& command);
void add_flags(CLI::App& app, BudgetCommand& command);
void add_flags(CLI::App& app, RecordCommand& command);
void add_flags(CLI::App& app, RecoverCommand& command);
void add_flags(CLI::App& app, ThesisCommand& command);
void add_flags(CLI::App& app, FleetCommand& command);

}  // namespace proofmass::app
