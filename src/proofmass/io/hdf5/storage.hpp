#pragma once

#include <hdf5.h>
#include <string>
#include <string_view>

namespace proofmass::io::hdf5 {

/// "float64", "int16", "bool"; empty if not a number.
[[nodiscard]] std::string type_name(hid_t type);

/// Kind of a non-numeric type: "text", "references".
[[nodiscard]] std::string_view kind_of(hid_t type);

/// The reason why a dataset cannot be read: in another file, in chunks too large, compressed by a
/// filter that is not built in; empty if it can.
[[nodiscard]] std::string storage_refusal(hid_t dataset);

}  // namespace proofmass::io::hdf5
