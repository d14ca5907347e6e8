#include "proofmass/io/layouts/layout.hpp"

#include "proofmass/io/cell.hpp"
#include "proofmass/io/csv/layout.hpp"

namespace proofmass::io {

std::string text_of(Archive& archive, std::size_t entry) {
  constexpr std::size_t most_bytes = std::size_t{64} << 10;
  const auto source = archive.open(entry);
  if (!source) return {};
  const auto text = (*source)->peek(most_bytes);
  if (!text) return {};
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  return std::string(text->starts_with(byte_order_mark) ? text->substr(3) : *text);
}

std::string field_of(std::string_view line, char separator, std::size_t column) {
  std::vector<std::string_view> fields;
  split_fields(line, separator, fields);
  return column < fields.size() ? std::string(trimmed(fields[column])) : std::string{};
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace proofmass::io
