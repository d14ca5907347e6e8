#pragma once

#include <vector>

#include "proofmass/signal/rests/runs.hpp"

// Start and end of a rest.
namespace proofmass::signal {

/// Trims the ends of a run:
/// - one block, unless the recording begins or ends there;
/// - half windows that are more than twice as noisy, as a variance, as the run's quietest quarter
///   and as the rest noise;
/// - segments of 1, 2, 4, … blocks that deviate from the mean of the adjacent segment.
/// Noise alone triggers the last two at one end in 2000 for each length.
void trim_ends(const RestBlocks& blocks, const RestNoise& noise, RestRun& run);

/// Joins runs separated by no more than a window if their means agree and the sensor did not change
/// position in between: a shock. Both must be at least a window long. A stroke from rest to rest
/// leaves the level unchanged, too.
void join_runs(const RestBlocks& blocks, const RestNoise& noise, std::vector<RestRun>& runs);

}  // namespace proofmass::signal
