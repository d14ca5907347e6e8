#pragma once

#include <vector>

#include "noise/command.hpp"
#include "noise/pieces.hpp"

// The noise of recordings that are parts of one.
namespace proofmass::app {

/// Analyses each channel over all files as one recording with gaps: --as-one. The files follow each
/// other in time, by --starts or by their own clocks; one after the other is in memory. Throws
/// Failure, also where they overlap, or differ in rate or channels.
[[nodiscard]] std::vector<NoiseChannel> analyse_joined(const NoiseCommand& command,
                                                       const characterise::NoiseOptions& noise,
                                                       std::vector<Note>& notes);

}  // namespace proofmass::app
