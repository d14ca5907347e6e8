#pragma once

#include <hdf5.h>
#include <string>
#include <string_view>

namespace proofmass::io {

/// "float64", "int16", "bool"; empty for what is no number.
[[nodiscard]] std::string type_name(hid_t type);

/// What a type is that is no number: "text", "references".
[[nodiscard]] std::string_view kind_of(hid_t type);

/// Why a dataset's storage is not read: in another file, in chunks too large, packed by a filter
/// that is not built in; empty where it is.
[[nodiscard]] std::string storage_refusal(hid_t dataset);

}  // namespace proofmass::io
