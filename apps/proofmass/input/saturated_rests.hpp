#pragma once

#include <cstddef>
#include <vector>

#include "proofmass/calibrate/pose_means.hpp"
#include "proofmass/core/recording.hpp"

namespace proofmass::app {

/// signal::drop_saturated_rests(), whose warnings are added to those of the recording. Before a
/// sensor file's calibration mixes the axes. Returns whether there were any.
bool drop_saturated_rests(const std::vector<std::size_t>& channels, Recording& recording);

/// Whether each channel has two values or more in a static interval.
[[nodiscard]] bool is_measured(const Recording& recording,
                               const std::vector<std::size_t>& channels,
                               const calibrate::Dwell& dwell);

}  // namespace proofmass::app
