#include "proofmass/io/shown_text.hpp"

#include "proofmass/io/cell.hpp"

namespace proofmass::io {
namespace {

/// Bytes of the character of UTF-8 that a text begins with; 0 where it begins with none.
std::size_t character_bytes(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return 1;
  const std::size_t bytes = lead < 0xC2   ? 0
                            : lead < 0xE0 ? 2
                            : lead < 0xF0 ? 3
                            : lead < 0xF5 ? 4
                                          : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  const auto second = static_cast<unsigned char>(text[1]);
  const bool is_overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool is_none = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
  return is_overlong || is_none ? 0 : bytes;
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t most = 120;
  text = trimmed(text);
  std::string out;
  while (!text.empty()) {
    if (out.size() >= most) return out + " …";
    const std::size_t bytes = character_bytes(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (bytes == 0) {
      // What is no UTF-8 is taken for Latin-1, which old programs write.
      out += static_cast<char>(0xC0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3F));
    } else if (byte < ' ' || byte == 127) {
      out += ' ';
    } else {
      out += text.substr(0, bytes);
    }
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return out;
}

}  // namespace proofmass::io
