#pragma once

#include <hdf5.h>
#include <string>

namespace proofmass::io {

// Values that stand beside figures; false where they cannot be written.

/// A single number of a type in memory.
[[nodiscard]] bool put_attribute(hid_t owner, const char* name, hid_t type, const void* value);
[[nodiscard]] bool put_text(hid_t owner, const std::string& name, const std::string& text);
/// A text of any length: attributes have room for 64 KiB.
[[nodiscard]] bool put_text_dataset(hid_t group, const std::string& name, const std::string& text);

}  // namespace proofmass::io
