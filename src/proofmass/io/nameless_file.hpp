#pragma once

#include <string>

namespace proofmass::io {

/// The descriptor of a new file in a folder that has no name, or has lost it, and is gone when it
/// is closed; -1 with errno where there can be none.
[[nodiscard]] int nameless_file(const std::string& folder);

}  // namespace proofmass::io
