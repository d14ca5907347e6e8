#pragma once

#include <string>
#include <vector>

#include "noise/command.hpp"
#include "noise/streaming.hpp"

// Noise of a recording that is split into several files, by sums that are made of each by itself.
namespace proofmass::app {

/// Throws Failure where a flag is given that analyses of several files as one do not take.
void check_joined_flags(const NoiseCommand& command);

/// Prints what fleet::RecordingSums keeps of the only file: with the place that --sums names its
/// sums, without one what is needed to find its place. Throws Failure.
void print_sums(const NoiseCommand& command, const characterise::NoiseOptions& noise);

/// Whether the first file holds sums instead of a recording.
[[nodiscard]] bool holds_sums(const NoiseCommand& command);

/// Joins the sums in the files, in any order, to the analysis of the recordings as one. Replaces
/// `inputs` by the names of the recordings. Throws Failure.
[[nodiscard]] std::vector<NoiseChannel> join_sums(const NoiseCommand& command,
                                                  const characterise::NoiseOptions& noise,
                                                  std::vector<std::string>& inputs,
                                                  std::vector<Note>& notes);

}  // namespace proofmass::app
