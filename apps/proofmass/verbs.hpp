#pragma once

#include "command_line.hpp"

// The verbs: each reads, calls the library, and publishes. Throw Failure.
namespace proofmass::app {

void run(const InspectCommand& command);
void run(const ConvertCommand& command);
void run(const WheelCommand& command);
void run(const NoiseCommand& command);
void run(const DriftCommand& command);
void run(const CalibrateCommand& command);
void run(const TumbleCommand& command);
void run(const TiltCommand& command);
void run(const TrackCommand& command);
void run(const TuneCommand& command);
void run(const SimulateCommand& command);
void run(const BudgetCommand& command);
void run(const RecordCommand& command);
void run(const RecoverCommand& command);
void run(const SensorCommand& command);
void run(const ThesisCommand& command);
void run(const FleetCommand& command);

}  // namespace proofmass::app
