#pragma once

#include "calibrate/command.hpp"

namespace proofmass::app {

/// `calibrate --encoder`: an encoder's errors by the accelerometers on its wheel. Throws Failure.
void run_calibrate_encoder(const CalibrateCommand& command);

}  // namespace proofmass::app
