#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass::signal {

/// Which values of a channel are at an end of its range: equal to its lowest or highest value three
/// times or more in a row, if the signal runs into that value (as in audit.hpp) and does not merely
/// stay there. Lower magnitudes than 95 % of the largest are no end of a symmetric range, that of a
/// gyroscope. A constant channel is at its end throughout; NaN is not.
[[nodiscard]] std::vector<bool> at_range_end(View<double> series);

/// The rows in which any axis of a gyroscope is at an end of its range. A constant axis, as of
/// exact numbers, is not. Axes of one length.
[[nodiscard]] std::vector<bool> saturated_rows(const std::array<std::vector<double>, 3>& axes);

/// Makes the marked rows NaN; returns their number.
std::size_t drop_rows(const std::vector<bool>& rows, std::array<std::vector<double>, 3>& axes);

}  // namespace proofmass::signal
