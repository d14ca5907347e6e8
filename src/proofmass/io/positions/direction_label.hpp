#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace proofmass::io {

/// The direction of the specific force (upwards) given by the name of a position, as a unit vector
/// in the sensor's nominal axes; nullopt if the name has none ("x_rot", "walking").
///
/// An axis letter with a sign before or after it: "+x", "x-", "X+"; or, optionally separated by a
/// blank, '_' or '-': p, pos, positive, plus, up, top and a, n, neg, negative, minus, down, bottom.
/// An axis that points down measures -g: "z down" is (0, 0, -1). The single letters are those of
/// the Ferraris positions: p parallel to the reaction of gravity, a antiparallel.
/// Source: Ferraris, Grimaldi, Parvis, Procedure for effortless in-field calibration of three-axis
/// rate gyros and accelerometers (1995).
[[nodiscard]] std::optional<std::array<double, 3>> direction_of_label(std::string_view label);

}  // namespace proofmass::io
