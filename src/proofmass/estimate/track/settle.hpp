#pragma once

#include <vector>

#include "proofmass/estimate/track/solve.hpp"

// Selection of the stops.
namespace proofmass::estimate {

/// If the whole recording is as quiet as rest, slow motion may be hidden in its noise: then only
/// the two ends are used as rests, and the interval is that of a motion between them.
void keep_ends_of_rest(TrackSignal& signal);

/// At a turning point the acceleration is largest and momentarily constant, which resembles a short
/// rest. Removes short rests that contradict the motion between the long ones, and returns their
/// number.
std::size_t drop_belied_rests(TrackSignal& signal, View<double> accel, const TrackOptions& options);

/// Keeps the stops that are rests by the most likely hypothesis, and solves again. Without a clear
/// winner: returns the alternatives.
[[nodiscard]] std::vector<TrackAlternative> settle_stops(TrackSignal& signal,
                                                         const TrackOptions& options,
                                                         Result<AlongAxis>& solved);

}  // namespace proofmass::estimate
