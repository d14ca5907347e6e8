#include "proofmass/io/shown_text.hpp"

#include "proofmass/core/utf8.hpp"
#include "proofmass/io/cell.hpp"

namespace proofmass::io {
namespace {

/// True if a UTF-8 character is a control character, not a visible one.
bool is_control(std::string_view character) {
  const auto byte = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return byte < ' ' || byte == 127;
  if (character.size() == 2)  // U+0080 … U+009F, and U+061C, the Arabic letter mark
    return (byte == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0) ||
           character == "\xD8\x9C";
  // U+200E, U+200F, U+2028 … U+202E and U+2066 … U+2069.
  if (character.size() != 3 || byte != 0xE2) return false;
  const auto second = static_cast<unsigned char>(character[1]);
  const auto third = static_cast<unsigned char>(character[2]);
  return (second == 0x80 && (third == 0x8E || third == 0x8F || (third >= 0xA8 && third <= 0xAE))) ||
         (second == 0x81 && third >= 0xA6 && third <= 0xA9);
}

/// The first `most` bytes or so of a text, cleaned; the remainder stays in `text`.
std::string cleaned(std::string_view& text, std::size_t most) {
  std::string out;
  while (!text.empty() && out.size() < most) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view character = text.substr(0, bytes == 0 ? 1 : bytes);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (is_control(character) || (bytes == 0 && byte < 0xA0)) {
      out += ' ';
    } else if (bytes == 0) {
      // Invalid UTF-8 is treated as Latin-1, which old programs write.
      out += static_cast<char>(0xC0 | byte >> 6);
      out += static_cast<char>(0x80 | (byte & 0x3F));
    } else {
      out += character;
    }
    text.remove_prefix(character.size());
  }
  return out;
}

}  // namespace

std::string clean_text(std::string_view text) {
  return cleaned(text, std::string_view::npos);
}

void clean_texts(Recording& recording) {
  const auto clean = [](std::string& text) { text = clean_text(text); };
  for (Channel& channel : recording.channels) {
    clean(channel.name);
    clean(channel.unit.symbol);
  }
  for (Label& label : recording.labels) clean(label.text);
  for (Note& note : recording.notes) clean(note.text);
  clean(recording.label_channel);
  clean(recording.time.channel);
}

std::string shown(std::string_view text) {
  constexpr std::size_t most = 120;
  text = trimmed(text);
  const std::string out = cleaned(text, most);
  return text.empty() ? out : out + " …";
}

}  // namespace proofmass::io
