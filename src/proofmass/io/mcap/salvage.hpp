#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io::mcap {

/// Receives the bytes of a new file, piece by piece.
using PutBytes = std::function<Status(const std::string& bytes)>;

/// Reads the intact part of any MCAP file: up to damage, and from the next intact chunk on. Writes
/// it to a new, complete file, with the messages in the same order and with the same times, chunks
/// uncompressed. Recovery::file stays empty.
/// Source: MCAP format specification, version 0.
/// Errors: unreadable, corrupt (nothing intact), those of `put`.
/// Cost: one pass if nothing is damaged; one chunk in memory.
[[nodiscard]] Result<Recovery> salvage(const std::string& path,
                                       const PutBytes& put,
                                       const Progress& progress = {});
/// The same for bytes in memory.
[[nodiscard]] Result<Recovery> salvage(std::span<const std::byte> bytes, const PutBytes& put);

}  // namespace proofmass::io::mcap
