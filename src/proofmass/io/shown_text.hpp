#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// A text that a file gives, for a name or a note: UTF-8 whatever it was, on one line, cut behind
/// 120 bytes.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace proofmass::io
