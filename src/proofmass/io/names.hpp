#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// ASCII letters in lower case, whatever the locale.
[[nodiscard]] inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

/// The letters and digits of a name in lower case: "Sample-Time fine" is "sampletimefine".
[[nodiscard]] inline std::string bare_name(std::string_view text) {
  std::string out = lower(text);
  std::erase_if(out, [](char c) { return (c < 'a' || c > 'z') && (c < '0' || c > '9'); });
  return out;
}

}  // namespace proofmass::io
