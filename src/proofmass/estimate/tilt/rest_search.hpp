#pragma once

#include "proofmass/estimate/tilt.hpp"
#include "proofmass/signal/rests.hpp"

// Where the base was at rest.
namespace proofmass::estimate {

/// Intervals in which the accelerometer was at rest with a constant level. A search by noise level
/// accepts a slow motion within a rest as drift; here a rest is split where the mean of half a
/// second departs from that of the rest before it by more than noise and the drift of a sensor at
/// rest; a part whose level moves on is dropped.
[[nodiscard]] signal::RestSearch rests_of(const TiltRecord& record, const TiltOptions& options);

/// For a moving base: drops quiet intervals that join smoothly to their neighbours, such as the
/// crest of a slow acceleration, because a rest begins or ends abruptly; and those whose level
/// changes by more than 2 mg √(duration/60 s), clearly beyond noise.
void drop_slow_motion(const TiltRecord& record, signal::RestSearch& found);

/// For a moving base with a gyroscope: rests are divided at tenths of a second whose rate departs
/// from the median of the rest by more than 0.002 rad/s and six standard deviations.
void leave_out_rotations(const TiltRecord& record,
                         const TiltOptions& options,
                         signal::RestSearch& found);

/// For a moving base: next to motion a rest loses 0.4 s, or a quarter, in which a slow onset is
/// hidden in the noise. Angles there would be stated to be those of the rest, to its accuracy. An
/// interval between motions is dropped if less than the shortest rest then remains, because a slow
/// acceleration may be constant for that long.
void leave_out_hidden_onsets(const TiltRecord& record,
                             const TiltOptions& options,
                             signal::RestSearch& found);

}  // namespace proofmass::estimate
