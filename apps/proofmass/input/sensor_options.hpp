#pragma once

#include <optional>

#include "proofmass/estimate/track.hpp"
#include "proofmass/sensor/sensor_model.hpp"

// Figures of a sensor file for an estimate of displacement.
namespace proofmass::app {

/// Relative standard deviation of the scale: the largest of the three axes, since the direction of
/// the motion is not known yet.
[[nodiscard]] std::optional<double> scale_std_of(const sensor::Calibration& calibration);

/// White noise and random walk; the time constant of the warm-up only if its curve was subtracted.
[[nodiscard]] estimate::AccelFigures figures_of(const sensor::SensorModel& model,
                                                bool warm_up_removed);

}  // namespace proofmass::app
