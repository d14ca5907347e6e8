#pragma once

#include "proofmass/estimate/track_signal.hpp"

// The track of a sensor with a gyroscope. Private to the module's track*.cpp.
namespace proofmass::estimate {

/// Position by the error-state filter and smoother of attitude.hpp, which turns the measurements
/// into the world and takes gravity out; along the direction in which it moved farthest. Fills all
/// of `solution` but what track.cpp works out of its series. Errors: as estimate_attitude();
/// not_observable where a gap parts the record.
[[nodiscard]] Result<bool> track_carried(const TrackSensor& sensor,
                                         const TrackSignal& signal,
                                         const TrackReadings& readings,
                                         const TrackOptions& options,
                                         TrackSolution& solution);

}  // namespace proofmass::estimate
