#pragma once

#include <vector>

#include "proofmass/estimate/track_solve.hpp"

// Which stops are used. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// Where all of the recording is as quiet as rest, a slow motion may hide in its noise: then only
/// the two ends are taken for rests, and the interval is that of a motion between them.
void keep_ends_of_rest(TrackSignal& signal);

/// Where a motion turns round, its acceleration is greatest and for a moment constant, which looks
/// like a short rest. Short ones that the motion between the long ones belies are taken out.
/// Returns how many.
std::size_t drop_belied_rests(TrackSignal& signal, View<double> accel, const TrackOptions& options);

/// Leaves of the stops what are rests by the likeliest hypothesis, and solves anew. Where that does
/// not win clearly: the alternatives.
[[nodiscard]] std::vector<TrackAlternative> settle_stops(TrackSignal& signal,
                                                         const TrackOptions& options,
                                                         Result<AlongAxis>& solved);

}  // namespace proofmass::estimate
