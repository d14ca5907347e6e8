#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace proofmass::io {

/// The direction of the specific force (upwards) that the name of a position says, as a unit vector
/// in the sensor's nominal axes; nullopt where the name says none ("x_rot", "walking").
/// An axis letter with a sign before or behind it: "+x", "x-", "X+"; or, with or without a blank,
/// '_' or '-' between: p, pos, positive, plus, up, top and a, n, neg, negative, minus, down,
/// bottom. An axis that points down reads -g: "z down" is (0, 0, -1). The single letters are those
/// of the Ferraris positions: p along gravity's reaction, a against it.
/// Source: Ferraris, Grimaldi, Parvis, Procedure for effortless in-field calibration of three-axis
/// rate gyros and accelerometers (1995).
[[nodiscard]] std::optional<std::array<double, 3>> direction_of_label(std::string_view label);

}  // namespace proofmass::io
