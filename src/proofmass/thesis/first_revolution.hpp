#pragma once

#include "proofmass/thesis/first_turn.hpp"

// Where the first revolution of a record begins and ends.
namespace proofmass::thesis {

/// From its whole record to its first revolution. Expects all estimates and readings over the whole
/// record.
void cut_to_first_revolution(FirstTurn& turn);

}  // namespace proofmass::thesis
