#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>

namespace proofmass::io {

/// ASCII letters in lower case, independent of the locale.
[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

/// True if a character is a lower-case ASCII letter.
[[nodiscard]] inline bool is_lower_letter(char c) {
  return c >= 'a' && c <= 'z';
}

/// True if a word equals one of several exactly.
[[nodiscard]] inline bool is_any_of(std::string_view word,
                                    std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// The letters and digits of a name in lower case: "Sample-Time fine" is "sampletimefine".
[[nodiscard]] inline std::string bare_name(std::string_view text) {
  std::string out = lower(text);
  std::erase_if(out, [](char c) { return (c < 'a' || c > 'z') && (c < '0' || c > '9'); });
  return out;
}

/// True if a name equals one of several bare names.
template <std::size_t N>
[[nodiscard]] bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  const std::string bare = bare_name(name);
  return std::ranges::find(names, std::string_view(bare)) != names.end();
}

}  // namespace proofmass::io
