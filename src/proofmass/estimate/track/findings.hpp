#pragma once

#include <optional>

#include "proofmass/estimate/track/signal.hpp"

// Notes on a track for the user.
namespace proofmass::estimate {

/// Why no result is possible, and what to record.
[[nodiscard]] Error no_stop(const TrackSignal& signal);

/// Why the assumed rests may be motion.
[[nodiscard]] Error hidden_motion();

/// If there is a gap of more than a minute: the displacement across it may be any.
[[nodiscard]] std::optional<Error> unbridgeable_gap(const TrackSignal& signal);

/// Relative uncertainty of the measurements' scale along the solution's axis: as given; else 1 %,
/// but along gravity its departure at rest from the expected value, at least 0.3 %.
[[nodiscard]] double scale_std(const TrackSignal& signal,
                               const TrackOptions& options,
                               const TrackSolution& solution);

/// Adds the notes.
void add_findings(const TrackSignal& signal, const TrackOptions& options, TrackSolution& solution);

}  // namespace proofmass::estimate
