#pragma once

#include <string_view>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Gives a unit to the channels whose file names none, and says in a note why: --unit for the
/// accelerometers before anything else; known instruments by the names of their columns; else the
/// size of gravity in the quietest second of the accelerometers: 9.8 is m/s^2, 1 is g, 1000 is mg.
/// Whole numbers that fit none of these are counts.
[[nodiscard]] Status settle_units(Recording& recording, const ReadOptions& options);

/// Whether a name is an accelerometer's: by "acc", or by an axis and nothing else ("x", "ay2").
[[nodiscard]] bool is_accelerometer_name(std::string_view name);

}  // namespace proofmass::io
