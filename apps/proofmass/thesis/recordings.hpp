#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/thesis/programme.hpp"
#include "thesis/command.hpp"

namespace proofmass::app {

/// The recordings named by the flags, each read as by the verb of its kind: drift, tumble, wheel.
/// Notes of reading are added to `notes`, with the file's name. Throws Failure.
[[nodiscard]] thesis::OwnRecordings own_recordings(const ThesisCommand& command,
                                                   std::vector<Note>& notes);

}  // namespace proofmass::app
