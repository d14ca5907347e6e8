#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace proofmass::io {

/// A character's bytes in UTF-8; half a surrogate pair, which is none, becomes '?'.
void append_utf8(std::string& out, std::uint32_t character);

/// The next character of UTF-8 and how many bytes it takes; a byte that is none stands for itself.
/// Expects that there is one.
[[nodiscard]] std::uint32_t next_character(std::string_view text, std::size_t& length);

}  // namespace proofmass::io
