#pragma once

#include <optional>

#include "proofmass/estimate/track.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// What a sensor file says to an estimate of displacement.
namespace proofmass::app {

/// Relative standard deviation of the scale; the largest of the three axes, since along which the
/// motion goes is not known yet.
[[nodiscard]] std::optional<double> scale_std_of(const sensor::Calibration& calibration);

/// White noise and walk; the time of the warm-up only where its course has been taken out.
[[nodiscard]] estimate::AccelFigures figures_of(const sensor::SensorModel& model,
                                                bool warm_up_removed);

}  // namespace proofmass::app
