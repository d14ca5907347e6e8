#pragma once

#include <span>
#include <string>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// The descriptor of a new unnamed file in a folder, deleted when it is closed; -1 with errno on
/// failure.
[[nodiscard]] int unnamed_file(const std::string& folder);

/// Unreadable: `what`, and the system's message for errno.
[[nodiscard]] Error system_failure(const std::string& what);

/// Writes all bytes; false, with errno set, if that fails.
[[nodiscard]] bool write_all(int descriptor, std::span<const char> bytes);

}  // namespace proofmass::io
