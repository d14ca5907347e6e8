#include "proofmass/io/text/wording.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace proofmass::io {

std::string in_words(double figure) {
  return fmt::format("{:.6g}", figure);
}

std::string times(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

std::string places(View<std::size_t> samples, std::size_t first_line) {
  constexpr std::size_t most = 5;
  std::string out = first_line > 0 ? "line" : "sample";
  if (samples.size() > 1) out += 's';
  for (std::size_t i = 0; i < std::min(samples.size(), most); ++i)
    out += fmt::format("{}{}", i == 0 ? " " : ", ", samples[i] + first_line);
  if (samples.size() > most) out += fmt::format(" and {} more", samples.size() - most);
  return out;
}

}  // namespace proofmass::io
