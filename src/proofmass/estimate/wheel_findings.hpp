#pragma once

#include <string>
#include <vector>

#include "proofmass/estimate/wheel_fit.hpp"
#include "proofmass/estimate/wheel_plane.hpp"

// What a fit says of the sensors, in figures where the recording tells them and in words where not.
namespace proofmass::estimate {

/// Fills radius, mounting, bias, scale, skew and phase of each sensor; a figure whose standard
/// deviation the recording has not brought below half of what was believed beforehand stays absent.
void describe_sensors(const WheelFit& fit, double phase_rad, std::vector<WheelSensorFit>& sensors);

/// One sentence for each direction in which the constants are hardly better known after the
/// recording than before: the eigenvectors of the covariance, in units of what was believed, whose
/// value is above a quarter. Says which quantities trade against each other and what would tell
/// them apart.
[[nodiscard]] std::vector<std::string> say_not_observable(
    const WheelFit& fit, const std::vector<WheelSensorFit>& sensors);

}  // namespace proofmass::estimate
