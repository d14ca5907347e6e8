#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/thesis/programme.hpp"
#include "thesis/command.hpp"

namespace proofmass::app {

/// The recordings that the flags name, each read as the verb for its kind reads it: drift, tumble,
/// wheel. Notes of reading are added to `notes`, behind the file's name. Throws Failure.
[[nodiscard]] thesis::OwnRecordings own_recordings(const ThesisCommand& command,
                                                   std::vector<Note>& notes);

}  // namespace proofmass::app
