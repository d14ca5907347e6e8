#include "cli/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace proofmass::app {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

constexpr std::array<Replacement, 2> in_figures{{{"\u2212", "-"}, {"\u202f", ""}}};

constexpr std::array<Replacement, 35> in_ascii{{
    {"\u00b1", "+-"},    {"\u00b5", "u"},     {"\u03bc", "u"},     {"\u00b0", " deg"},
    {"\u00b2", "^2"},    {"\u00b3", "^3"},    {"\u221a", "sqrt "}, {"\u00b7", "*"},
    {"\u00d7", "x"},     {"\u03c3", "sigma"}, {"\u03c4", "tau"},   {"\u03c9", "omega"},
    {"\u03c7", "chi"},   {"\u03b1", "alpha"}, {"\u03b2", "beta"},  {"\u03b3", "gamma"},
    {"\u03b4", "delta"}, {"\u0394", "delta"}, {"\u03b8", "theta"}, {"\u03bb", "lambda"},
    {"\u03bd", "nu"},    {"\u03c0", "pi"},    {"\u03c6", "phi"},   {"\u2013", "-"},
    {"\u2014", "-"},     {"\u2026", "..."},   {"\u2264", "<="},    {"\u2265", ">="},
    {"\u2248", "~"},     {"\u221e", "inf"},   {"\u2192", "->"},    {"\u00a0", " "},
    {"\u2019", "'"},     {"\u00bd", "1/2"},   {"\u2202", "d"},
}};

bool begins_letter(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

std::ptrdiff_t columns(std::string_view text) {
  return std::ranges::count_if(text, begins_letter);
}

// Replacement for the code point at the beginning of `text`; null if it is unchanged.
template <std::size_t N>
const Replacement* find(const std::array<Replacement, N>& all, std::string_view text) {
  const auto* const found = std::ranges::find_if(
      all, [&](const Replacement& one) { return text.starts_with(one.first); });
  return found == all.end() ? nullptr : found;
}

// The code point `letter`, at the beginning of `text`, as it is shown.
std::string_view plain_letter(std::string_view text, std::string_view letter, bool ascii) {
  const Replacement* found = find(in_figures, text);
  if (found == nullptr && ascii) found = find(in_ascii, text);
  if (found != nullptr) return found->second;
  return ascii && letter.size() > 1 ? "?" : letter;
}

std::string plain_cell(std::string_view cell, bool ascii) {
  std::string out;
  while (!cell.empty()) {
    std::size_t length = 1;
    while (length < cell.size() && !begins_letter(cell[length])) ++length;
    const std::string_view letter = cell.substr(0, length);
    std::string_view shown = plain_letter(cell, letter, ascii);
    if (shown != letter && out.ends_with(' ') && shown.starts_with(' ')) shown.remove_prefix(1);
    out += shown;
    cell.remove_prefix(length);
  }
  return out;
}

// The blanks after a cell absorb its change in length, so that columns remain aligned.
std::string plain_line(std::string_view line, bool ascii) {
  std::string out;
  std::ptrdiff_t shift = 0;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find("  "), line.size());
    const std::string cell = plain_cell(line.substr(0, end), ascii);
    shift += columns(cell) - columns(line.substr(0, end));
    out += cell;
    line.remove_prefix(end);
    const auto blanks =
        static_cast<std::ptrdiff_t>(std::min(line.find_first_not_of(' '), line.size()));
    const std::ptrdiff_t kept = blanks == 0 ? 0 : std::max<std::ptrdiff_t>(2, blanks - shift);
    shift -= blanks - kept;
    line.remove_prefix(static_cast<std::size_t>(blanks));
    if (!line.empty()) out.append(static_cast<std::size_t>(kept), ' ');
  }
  return out;
}

// Indent of continuation lines: the last column's, or the line's plus two.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  const std::size_t lead = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.rfind("  ");
  if (gap != std::string_view::npos && gap + 2 > lead) {
    const auto column = static_cast<std::size_t>(columns(line.substr(0, gap + 2)));
    if (column <= width / 2) return column;
  }
  return lead + 2;
}

void add_wrapped(std::string_view line, std::size_t width, std::string& out) {
  const std::size_t indent = hanging_indent(line, width);
  std::size_t column = 0;
  bool is_first = true;
  while (!line.empty()) {
    // A word with the blanks before it, which are kept within a line.
    const std::size_t blanks = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find(' ', blanks), line.size());
    const auto length = static_cast<std::size_t>(columns(line.substr(blanks, end - blanks)));
    const bool goes_over = !is_first && column + blanks + length > width && column > indent;
    if (goes_over) {
      out += '\n';
      out.append(indent, ' ');
      column = indent;
    } else {
      out.append(blanks, ' ');
      column += blanks;
    }
    out += line.substr(blanks, end - blanks);
    column += length;
    is_first = false;
    line.remove_prefix(end);
  }
}

bool is_ascii_terminal() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    std::string locale = value;
    std::ranges::transform(locale, locale.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return locale.find("utf-8") == std::string::npos && locale.find("utf8") == std::string::npos;
  }
  return false;
}

}  // namespace

std::string plain_text(std::string_view text, bool ascii) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    out += plain_line(text.substr(0, end), ascii);
    text.remove_prefix(end);
    if (text.empty()) break;
    out += '\n';
    text.remove_prefix(1);
  }
  return out;
}

std::string wrapped_text(std::string_view text, std::size_t width) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    add_wrapped(text.substr(0, end), width, out);
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string terminal_text(std::string_view text) {
  return plain_text(text, is_ascii_terminal());
}

std::string shown_text(std::string_view text) {
  winsize size{};
  std::string plain = terminal_text(text);
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return plain;
  return wrapped_text(plain, size.ws_col);
}

}  // namespace proofmass::app
