#pragma once

#include <vector>

#include "proofmass/signal/rest_runs.hpp"

// Where a rest begins and ends.
namespace proofmass::signal {

/// Takes off an end of a run: a block, unless the recording begins or ends there; half windows that
/// are more than twice as noisy, as a variance, as the run's quietest quarter and as rest; and what
/// departs from the mean of the stretch beside it, for stretches of 1, 2, 4, … blocks. Noise alone
/// reaches the last two at one end in 2000 for each length.
void trim_ends(const RestBlocks& blocks, const RestNoise& noise, RestRun& run);

/// Joins runs whose means agree on both sides of no more than a window, if what lies between moved
/// the sensor nowhere: it was a knock. Both must be as long as a window. A stroke from rest to rest
/// leaves the level as it was, too.
void join_runs(const RestBlocks& blocks, const RestNoise& noise, std::vector<RestRun>& runs);

}  // namespace proofmass::signal
