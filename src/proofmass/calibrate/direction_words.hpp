#pragma once

#include <Eigen/Core>
#include <string>

// Descriptions of the sensor's orientation, and instructions to set it, for a person.
namespace proofmass::calibrate {

/// "+z up", "+z up, 12° to +x", "−x up, 40° to +y and +z": for a force in the sensor's axes. Empty
/// if it is zero.
[[nodiscard]] std::string direction_words(const Eigen::Vector3d& force);

/// "lay it with +z straight up", "tilt it until −x and +y both point 45° above the horizontal":
/// `side` has 1 or −1 for the axes that point upwards or downwards, 0 for the others.
[[nodiscard]] std::string laying_words(const Eigen::Vector3i& side);

}  // namespace proofmass::calibrate
