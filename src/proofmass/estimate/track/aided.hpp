#pragma once

#include "proofmass/estimate/track/signal.hpp"

// The track of a sensor with a gyroscope.
namespace proofmass::estimate {

/// The accelerations in world axes, without gravity, by the attitude that the gyroscope measures
/// between the first and the last rest: acceleration in the quiet intervals between does not pass
/// for tilt. The rests are those of `signal`, two at least. Errors: as track_aided().
[[nodiscard]] Result<TrackSignal> world_signal(const TrackSensor& sensor,
                                               const TrackSignal& signal,
                                               const TrackOptions& options);

/// Position by the error-state filter and smoother of attitude.hpp, which rotates the measurements
/// to world axes and subtracts gravity; along the direction of the largest displacement. Fills all
/// of `solution` except what track.cpp derives from its series. Errors: as estimate_attitude();
/// not_observable if a gap splits the record.
[[nodiscard]] Result<bool> track_aided(const TrackSensor& sensor,
                                       const TrackSignal& signal,
                                       const TrackReadings& readings,
                                       const TrackOptions& options,
                                       TrackSolution& solution);

}  // namespace proofmass::estimate
