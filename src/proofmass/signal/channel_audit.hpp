#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/signal/audit.hpp"

namespace proofmass::signal {

/// The smallest normal single-precision number.
inline constexpr double least_normal = 0x1p-126;

/// Not zero, but below least_normal.
[[nodiscard]] inline bool is_denormal(double value) {
  return value != 0.0 && std::abs(value) < least_normal;
}

/// True if finite, of a plausible magnitude, and not denormal.
[[nodiscard]] inline bool is_plausible(double value) {
  return std::abs(value) <= absurd_magnitude && !is_denormal(value);
}

/// The value, or NaN if it is not plausible.
[[nodiscard]] inline double plausible_or_nan(double value) {
  return is_plausible(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

/// The quantisation step of a series, or nullopt if it looks continuous; determined from a
/// Subsample of 2^18 of its plausible values.
[[nodiscard]] std::optional<double> find_lsb(View<double> series);

/// The same from a sample of plausible values.
[[nodiscard]] std::optional<double> find_lsb_of_plausible(std::vector<double> values);

}  // namespace proofmass::signal
