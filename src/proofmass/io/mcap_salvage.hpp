#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording_log.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Gets the bytes of a new file, piece after piece.
using PutBytes = std::function<Status(const std::string& bytes)>;

/// Reads what is whole of an MCAP file, whoever wrote it: up to damage, and from the next whole
/// chunk on. Puts it into a new one with all that a file needs at its end, its messages in the same
/// order and with the same times, its chunks not compressed. Recovery::file stays empty.
/// Source: MCAP format specification, version 0.
/// Errors: unreadable, corrupt (nothing in it is whole), those of `put`.
/// Cost: one pass where nothing is damaged; one chunk in memory.
[[nodiscard]] Result<Recovery> salvage_mcap(const std::string& path,
                                            const PutBytes& put,
                                            const Progress& progress = {});
/// The same of bytes that are in memory.
[[nodiscard]] Result<Recovery> salvage_mcap(std::span<const std::byte> bytes, const PutBytes& put);

}  // namespace proofmass::io
