#pragma once

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms_cursor.hpp"
#include "proofmass/io/tdms_value.hpp"

namespace proofmass::io {

/// Reads the properties of an object: how many, then name, type and value of each.
/// Errors: corrupt (a type whose size is not known). Where the file breaks off the cursor says so.
[[nodiscard]] Status read_tdms_properties(TdmsCursor& cursor, TdmsProperties& properties);

}  // namespace proofmass::io
