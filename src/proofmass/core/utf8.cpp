#include "proofmass/core/utf8.hpp"

namespace proofmass {
namespace {

constexpr unsigned char byte_of(char c) {
  return static_cast<unsigned char>(c);
}

// Length that a first byte announces; 0: none begins with it.
std::size_t announced_bytes(unsigned char lead) {
  if (lead < 0x80) return 1;
  if (lead < 0xC2) return 0;
  if (lead < 0xE0) return 2;
  if (lead < 0xF0) return 3;
  return lead < 0xF5 ? 4 : 0;
}

// Overlong forms, surrogates and characters above U+10FFFF show in the second byte.
bool may_follow(unsigned char lead, unsigned char second) {
  switch (lead) {
    case 0xE0:
      return second >= 0xA0;
    case 0xED:
      return second < 0xA0;
    case 0xF0:
      return second >= 0x90;
    case 0xF4:
      return second < 0x90;
    default:
      return true;
  }
}

}  // namespace

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

std::size_t character_bytes(std::string_view text) {
  const unsigned char lead = byte_of(text[0]);
  const std::size_t bytes = announced_bytes(lead);
  if (bytes == 0 || text.size() < bytes) return 0;
  for (const char c : text.substr(1, bytes - 1))
    if ((byte_of(c) & 0xC0) != 0x80) return 0;
  return bytes == 1 || may_follow(lead, byte_of(text[1])) ? bytes : 0;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

}  // namespace proofmass
