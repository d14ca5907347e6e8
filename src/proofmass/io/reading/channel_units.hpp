#pragma once

#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Determines the units of channels without one, and states the reason in a note. In order of
/// precedence: --unit for the accelerometers; known instruments by their column names; the
/// magnitude of gravity in the quietest second of the accelerometers: 9.8 is m/s^2, 1 is g, 1000 is
/// mg. Integers that match none of these are counts.
[[nodiscard]] Status settle_units(Recording& recording, const ReadOptions& options);

/// True if a name is an accelerometer's: it contains "acc", or is an axis alone ("x", "ay2").
[[nodiscard]] bool is_accelerometer_name(std::string_view name);

}  // namespace proofmass::io
