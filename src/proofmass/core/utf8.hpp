#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// Characters of UTF-8.
namespace proofmass {

/// A character's bytes in UTF-8; an unpaired surrogate becomes '?'.
void append_utf8(std::string& out, std::uint32_t character);

/// The next character of UTF-8 and its length in bytes; an invalid byte is returned as itself.
/// Precondition: non-empty.
[[nodiscard]] std::uint32_t next_character(std::string_view text, std::size_t& length);

/// Length in bytes of the character at the beginning of a text; 0 if it is not well-formed: an
/// overlong form, a surrogate, a character above U+10FFFF. Precondition: non-empty. Source: The
/// Unicode Standard 15.0, table 3-7.
[[nodiscard]] std::size_t character_bytes(std::string_view text);

/// Whether all of it is well-formed.
[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace proofmass
