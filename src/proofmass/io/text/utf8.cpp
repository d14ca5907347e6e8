#include "proofmass/io/text/utf8.hpp"

namespace proofmass::io {

void append_utf8(std::string& out, std::uint32_t character) {
  if (character >= 0xD800 && character < 0xE000) character = '?';
  const auto tail = [&](int shift) {
    out += static_cast<char>(0x80 | ((character >> shift) & 0x3F));
  };
  if (character < 0x80) {
    out += static_cast<char>(character);
  } else if (character < 0x800) {
    out += static_cast<char>(0xC0 | (character >> 6));
    tail(0);
  } else if (character < 0x10000) {
    out += static_cast<char>(0xE0 | (character >> 12));
    tail(6);
    tail(0);
  } else {
    out += static_cast<char>(0xF0 | (character >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
}

std::uint32_t next_character(std::string_view text, std::size_t& length) {
  const auto lead = static_cast<unsigned char>(text[0]);
  length = lead < 0xC0 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  const std::uint32_t mask = length == 1 ? 0xFF : 0x7Fu >> length;
  std::uint32_t character = lead & mask;
  for (std::size_t i = 1; i < length; ++i) {
    const bool goes_on = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
    if (!goes_on) {
      length = 1;
      return lead;
    }
    character = character << 6 | (static_cast<unsigned char>(text[i]) & 0x3Fu);
  }
  return character;
}

}  // namespace proofmass::io
