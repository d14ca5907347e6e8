#include "proofmass/serve/utf8.hpp"

#include <array>
#include <cstddef>

namespace proofmass::serve {
namespace {

// Length of the sequence that a first byte announces; 0: it can be none.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

}  // namespace

bool is_utf8(std::string_view text) {
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  constexpr char32_t last = 0x10FFFF, surrogates = 0xD800, behind_surrogates = 0xE000;
  for (std::size_t k = 0; k < text.size();) {
    const auto first = static_cast<unsigned char>(text[k]);
    const std::size_t length = length_of(first);
    if (length == 0 || k + length > text.size()) return false;
    char32_t point = length == 1 ? first : first & (0x7FU >> length);
    for (std::size_t j = 1; j < length; ++j) {
      const auto next = static_cast<unsigned char>(text[k + j]);
      if ((next & 0xC0U) != 0x80U) return false;
      point = (point << 6) | (next & 0x3FU);
    }
    if (point < least[length] || point > last) return false;
    if (point >= surrogates && point < behind_surrogates) return false;
    k += length;
  }
  return true;
}

}  // namespace proofmass::serve
