#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/estimate/drive/trace.hpp"

// Integrated yaw rate of a gyroscope on a wheel or on the frame. Private to the module.
namespace proofmass::estimate::drive {

/// Adds the yaw that a wheel's gyroscope measured to its trace, from the axes in the plane of the
/// wheel: that along the axle may be missing, and so may the accelerations. Where they are missing
/// themselves, the rate is interpolated (Trace::yaw_gap_rad2).
void add_yaw(const WheelSensor& sensor, Trace& trace);

/// Yaw of the frame: its rate along the mean specific force, less the bias at rest. `rests` are the
/// intervals, on the frame's clock, in which the wheels stand. Errors: invalid_argument (no
/// gyroscope), not_observable (no rest of a second: the bias is unknown).
[[nodiscard]] Result<Trace> trace_frame(const WheelSensor& sensor,
                                        const std::vector<Stretch>& rests);

}  // namespace proofmass::estimate::drive
