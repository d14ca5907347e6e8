#pragma once

#include <string>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// Reads what is whole of an MCAP file, ours or another's, and writes it anew with its index and
/// summary. Never writes over `from`.
/// Errors: unreadable, corrupt (not an MCAP file, or nothing in it is whole), invalid_argument
/// (`to` is `from`). Cost: one pass, one chunk in memory.
[[nodiscard]] Result<Recovery> recover(const std::string& from,
                                       const std::string& to,
                                       const Progress& progress = {});

}  // namespace proofmass::acquire
