#pragma once

#include "tumble/command.hpp"

// Variants of `tumble` other than static positions. Both throw Failure.
namespace proofmass::app {

/// --rotating: bias and scale factor of a sensor on a rotating wheel.
void run_rotation(const TumbleCommand& command);

/// --coefficients K0,K1,…: selected coefficients of the full model equation.
void run_model_equation(const TumbleCommand& command);

}  // namespace proofmass::app
