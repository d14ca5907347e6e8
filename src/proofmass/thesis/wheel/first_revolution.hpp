#pragma once

#include "proofmass/thesis/wheel/first_turn.hpp"

// Beginning and end of the first revolution of a record.
namespace proofmass::thesis {

/// Cuts the whole record to its first revolution. Expects all estimates and measurements over the
/// whole record.
void cut_to_first_revolution(FirstTurn& turn);

}  // namespace proofmass::thesis
