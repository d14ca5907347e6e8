#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace proofmass::io {

/// A character's bytes in UTF-8; an unpaired surrogate becomes '?'.
void append_utf8(std::string& out, std::uint32_t character);

/// The next character of UTF-8 and its length in bytes; an invalid byte is returned as itself.
/// Precondition: non-empty.
[[nodiscard]] std::uint32_t next_character(std::string_view text, std::size_t& length);

}  // namespace proofmass::io
