#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/cursor.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

/// Reads the properties of an object: their number, then name, type and value of each. Errors:
/// corrupt (a type of unknown size). If the file is truncated, the cursor is broken.
[[nodiscard]] Status read_properties(Cursor& cursor, Properties& properties);

}  // namespace proofmass::io::tdms
