#pragma once

#include "tumble/command.hpp"

// What `tumble` does other than positions at rest. Throw Failure.
namespace proofmass::app {

/// --rotating: bias and scale factor of a sensor on a wheel that turns.
void run_rotation(const TumbleCommand& command);

/// --coefficients K0,K1,…: chosen coefficients of the whole model equation.
void run_model_equation(const TumbleCommand& command);

}  // namespace proofmass::app
