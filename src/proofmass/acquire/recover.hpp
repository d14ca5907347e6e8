#pragma once

#include <string>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Recovers the intact part of an MCAP file, ours or from another program, and writes it to a new
/// file with index and summary. Never overwrites `from`.
/// Errors: unreadable, corrupt (not an MCAP file, or nothing intact), invalid_argument (`to` is
/// `from`). Cost: one pass, one chunk in memory.
[[nodiscard]] Result<Recovery> recover(const std::string& from,
                                       const std::string& to,
                                       const Progress& progress = {});

}  // namespace proofmass::acquire
