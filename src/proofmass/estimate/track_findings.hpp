#pragma once

#include "proofmass/estimate/track_signal.hpp"

// What a person should know of a track. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// Why nothing can be said, and what to record.
[[nodiscard]] Error no_stop(const TrackSignal& signal);

/// Why what was taken for rest may be motion.
[[nodiscard]] Error hidden_motion();

/// Relative uncertainty of the measurements' scale along the solution's axis: as given; else 1 %,
/// but upwards how far gravity at rest is from what it should be, at least 0.3 %.
[[nodiscard]] double scale_std(const TrackSignal& signal,
                               const TrackOptions& options,
                               const TrackSolution& solution);

/// Adds the notes.
void add_findings(const TrackSignal& signal, const TrackOptions& options, TrackSolution& solution);

}  // namespace proofmass::estimate
