#pragma once

#include <span>
#include <string>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// The descriptor of a new file in a folder that has no name, or has lost it, and is gone when it
/// is closed; -1 with errno where there can be none.
[[nodiscard]] int nameless_file(const std::string& folder);

/// Unreadable: `what`, and what the system says of it in errno.
[[nodiscard]] Error system_failure(const std::string& what);

/// Writes all bytes; false, with errno set, if that fails.
[[nodiscard]] bool write_all(int descriptor, std::span<const char> bytes);

}  // namespace proofmass::io
