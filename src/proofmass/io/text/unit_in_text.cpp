#include "proofmass/io/text/unit_in_text.hpp"

#include <algorithm>

#include "proofmass/core/units.hpp"

namespace proofmass::io {
namespace {

bool is_name_character(char c) {
  return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

std::string unit_symbol(std::string_view text) {
  const std::string_view first_word = text.substr(0, text.find(' '));
  for (const std::string_view spelling : {text, first_word})
    if (const auto unit = parse_unit(spelling)) return std::string(unit->symbol);
  return {};
}

std::string unit_in_text(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string_view::npos;
       at = text.find(name, at + 1)) {
    std::string_view rest = text.substr(at + name.size());
    if ((at > 0 && is_name_character(text[at - 1])) ||
        (!rest.empty() && is_name_character(rest[0])))
      continue;
    rest.remove_prefix(std::min(rest.find_first_not_of("`'\"*: "), rest.size()));
    std::string_view ends;
    if (rest.starts_with("in ")) {
      rest.remove_prefix(3);
      ends = " ,;)";
    } else if (rest.starts_with('(') || rest.starts_with('[')) {
      rest.remove_prefix(1);
      ends = ")],;";
    } else {
      continue;
    }
    std::string_view unit = rest.substr(0, rest.find_first_of(ends));
    while (unit.ends_with('.')) unit.remove_suffix(1);
    if (std::string symbol = unit_symbol(unit); !symbol.empty()) return symbol;
  }
  return {};
}

}  // namespace proofmass::io
