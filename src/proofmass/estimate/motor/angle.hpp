#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::estimate::motor {

/// In-plane accelerations of one sensor on the wheel, m/s².
using PlaneAxes = std::array<std::vector<double>, 2>;

/// The wheel's angle at each sample by gravity, unwrapped: atan2 of the two axes about the centre
/// of their circle. Several sensors are rotated into the axes of the first and added before that,
/// so that the forces of rotation cancel between opposite ones. No filter, so that the noise stays
/// white.
/// Errors: not_observable (the wheel turns by less than half a turn and a sensor's biases are not
/// known, or the axes do not see gravity).
[[nodiscard]] Result<std::vector<double>> angle_of(const std::vector<PlaneAxes>& sensors,
                                                   double gravity_mps2);

/// The two axes of three in which gravity turns.
[[nodiscard]] PlaneAxes plane_of(const std::array<std::vector<double>, 3>& axes);

}  // namespace proofmass::estimate::motor
