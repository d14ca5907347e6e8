#pragma once

#include <hdf5.h>
#include <string>

namespace proofmass::io::hdf5 {

// Values written beside the numbers; false if they cannot be written.

/// A scalar with a memory type.
[[nodiscard]] bool put_attribute(hid_t owner, const char* name, hid_t type, const void* value);
[[nodiscard]] bool put_text(hid_t owner, const std::string& name, const std::string& text);
/// A text of any length: attributes are limited to 64 KiB.
[[nodiscard]] bool put_text_dataset(hid_t group, const std::string& name, const std::string& text);

}  // namespace proofmass::io::hdf5
