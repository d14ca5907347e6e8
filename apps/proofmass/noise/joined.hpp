#pragma once

#include <cstddef>
#include <vector>

#include "noise/command.hpp"
#include "noise/streaming.hpp"
#include "proofmass/characterise/noise_stream.hpp"

// Noise of a recording that is split into several files.
namespace proofmass::app {

/// Adds missing samples.
void add_gap(characterise::NoiseStream& stream, std::size_t missing);

/// Analyses each channel over all files as one recording with gaps: --as-one. The files are ordered
/// by --starts or by their own clocks, and only one is in memory at a time. Throws Failure, also if
/// they overlap or differ in rate or channels.
[[nodiscard]] std::vector<NoiseChannel> analyse_joined(const NoiseCommand& command,
                                                       const characterise::NoiseOptions& noise,
                                                       std::vector<Note>& notes);

}  // namespace proofmass::app
