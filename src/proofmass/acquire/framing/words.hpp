#pragma once

#include <string_view>
#include <vector>

namespace proofmass::acquire {

/// The parts between any of the separators; empty parts are omitted.
[[nodiscard]] inline std::vector<std::string_view> words_of(std::string_view text,
                                                            std::string_view marks) {
  std::vector<std::string_view> words;
  for (std::size_t begin = text.find_first_not_of(marks); begin != std::string_view::npos;
       begin = text.find_first_not_of(marks)) {
    text.remove_prefix(begin);
    words.push_back(text.substr(0, text.find_first_of(marks)));
    text.remove_prefix(words.back().size());
  }
  return words;
}

}  // namespace proofmass::acquire
