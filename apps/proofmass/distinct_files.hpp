#pragma once

#include "command_line.hpp"

namespace proofmass::app {

/// Throws Failure (usage) where a file that the command would write is one that it reads (a
/// recording, or one in a folder of them, a list, a sensor file), or another that it writes. Files
/// are compared by what they are: links and detours do not matter. --update-sensor may name the
/// file of --sensor.
void hold_apart(const Command& command);

}  // namespace proofmass::app
