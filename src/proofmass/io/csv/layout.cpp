#include "proofmass/io/csv/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/csv/dialect.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

std::string_view trimmed_blanks(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t") - first + 1);
}

/// The complete lines of the text.
std::vector<Line> complete_lines(std::string_view text, char line_end, bool is_whole_text) {
  std::vector<Line> lines;
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = text.find(line_end, begin);
    if (end == std::string_view::npos && !is_whole_text && !lines.empty()) break;
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back({line, begin, number});
    if (end == std::string_view::npos) break;
    begin = end + 1;
  }
  return lines;
}

/// "sep=;" on the first line, as written by spreadsheets.
std::optional<char> separator_line(std::string_view line) {
  line = trimmed(line);
  if (line.size() != 5 || (!line.starts_with("sep=") && !line.starts_with("SEP=")))
    return std::nullopt;
  return line[4];
}

bool is_row(const std::vector<std::string_view>& fields, const CsvLayout& layout) {
  if (width_of(fields) != layout.columns.size() && fields.size() != layout.columns.size())
    return false;
  bool any = false;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (layout.columns[c] == ColumnKind::text) continue;
    // Words that occur only in some rows may occur in the very first.
    if (layout.columns[c] == ColumnKind::blank) {
      any = any || read_cell(fields[c], layout.point, layout.is_grouped).kind == CellKind::number;
      continue;
    }
    const CellKind kind = read_cell(fields[c], layout.point, layout.is_grouped).kind;
    const bool stands_for_value = layout.columns[c] == ColumnKind::number
                                      ? kind == CellKind::number
                                      : read_clock(fields[c]).has_value();
    if (kind == CellKind::text && !stands_for_value) return false;
    any = any || stands_for_value;
  }
  return any;
}

/// The text of a comment without its mark.
std::string without_mark(std::string_view line) {
  const auto first = line.find_first_not_of(" \t#%;/");
  return std::string(first == std::string_view::npos ? std::string_view{} : line.substr(first));
}

/// True if it increases over the rows examined, except for one in ten.
bool first_column_ascends(const std::vector<Line>& rows, const CsvLayout& layout) {
  if (layout.columns.empty() || layout.columns[0] != ColumnKind::number) return false;
  std::vector<std::string_view> fields;
  std::size_t up = 0;
  std::size_t steps = 0;
  double last = std::nan("");
  for (const Line& row : rows) {
    split_fields(row.text, layout.separator, fields);
    const double value = read_cell(fields.front(), layout.point, layout.is_grouped).value;
    if (!std::isnan(last) && !std::isnan(value)) {
      ++steps;
      if (value > last) ++up;
    }
    last = value;
  }
  return steps >= 2 && up * 10 >= steps * 9;
}

bool looks_binary(std::string_view head) {
  constexpr std::string_view usual("\t\n\r\0\f\x1A", 6);
  const auto odd = std::ranges::count_if(head, [&](char c) {
    return static_cast<unsigned char>(c) < 32 && usual.find(c) == std::string_view::npos;
  });
  return static_cast<std::size_t>(odd) * 50 > head.size();
}

/// Stores the lines before the first row as the preamble; returns the rows.
std::vector<Line> find_rows(const std::vector<Line>& lines, CsvLayout& layout) {
  std::vector<std::string_view> fields;
  std::vector<Line> rows;
  for (const Line& line : lines) {
    if (is_blank(line.text) || (line.number == 1 && separator_line(line.text))) continue;
    const bool remark = is_remark(line.text, layout.separator);
    split_fields(line.text, layout.separator, fields);
    if (!remark && is_row(fields, layout)) {
      rows.push_back(line);
    } else if (rows.empty()) {
      layout.preamble.push_back(
          {line.number, remark, remark ? without_mark(line.text) : std::string(line.text)});
    }
  }
  return rows;
}

std::string_view without_sign(std::string_view word) {
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  return word;
}

/// Removes the figures at the beginning of a word; false if no digit is among them.
bool take_figures(std::string_view& word) {
  constexpr std::string_view figures = "0123456789.,'_() %";
  constexpr std::string_view full_width = "\xEF\xBC";  // prefix of U+FF00 … U+FF3F
  bool has_digit = false;
  while (!word.empty()) {
    const bool is_wide = word.starts_with(full_width) && word.size() > 2;
    // Bytes of other characters, such as blanks and minus signs, are neutral.
    const bool is_other = static_cast<unsigned char>(word[0]) >= 0x80;
    if (!is_wide && !is_other && figures.find(word[0]) == std::string_view::npos) break;
    has_digit = has_digit || is_wide || is_digit(word[0]);
    word.remove_prefix(is_wide ? 3 : 1);
  }
  return has_digit;
}

/// True if a word is a number in an ambiguous notation: "(0.5)", "5 %", "1.5 g", "1.5D-3",
/// full-width digits.
bool is_odd_figure(std::string_view word) {
  word = without_sign(trimmed(word));
  if (!take_figures(word)) return false;
  if (!word.starts_with('D') && !word.starts_with('d'))
    return word.empty() || parse_unit(word).has_value();
  word = without_sign(word.substr(1));
  return !word.empty() && std::ranges::all_of(word, is_digit);
}

/// The words of a text column, and those that resemble numbers.
struct OddFigures {
  std::size_t words = 0, odd = 0;
  std::string first{};

  void add(std::string_view field) {
    field = trimmed(field);
    if (field.empty()) return;
    ++words;
    if (!is_odd_figure(field)) return;
    constexpr std::size_t longest = 24;
    if (odd++ == 0) first = field.substr(0, longest);
  }
  [[nodiscard]] bool is_most() const { return 2 * odd > words; }
};

/// Text columns that are mostly odd numbers.
void note_odd_figures(const std::vector<Line>& rows, CsvLayout& layout) {
  const std::size_t width = layout.columns.size();
  std::vector<OddFigures> columns(width);
  std::vector<std::string_view> fields;
  for (const Line& row : rows) {
    split_fields(row.text, layout.separator, fields);
    for (std::size_t c = 0; c < std::min(width, fields.size()); ++c)
      if (layout.columns[c] == ColumnKind::text) columns[c].add(fields[c]);
  }
  layout.odd_figures.clear();
  for (const OddFigures& column : columns)
    layout.odd_figures.push_back(column.is_most() ? column.first : std::string{});
}

/// Fills in the position of the rows and the preceding lines; false if there is no row.
bool place_rows(const std::vector<Line>& lines, CsvLayout& layout) {
  const std::vector<Line> rows = find_rows(lines, layout);
  if (rows.empty()) return false;
  layout.data_offset = rows.front().offset;
  layout.first_line = rows.front().number;
  std::size_t bytes = 0;
  for (const Line& row : rows) bytes += row.text.size() + 1;
  layout.bytes_per_row = static_cast<double>(bytes) / static_cast<double>(rows.size());
  layout.first_ascends = first_column_ascends(rows, layout);
  note_odd_figures(rows, layout);
  return true;
}

/// End of the field that starts at `begin`; separators within quotes are ignored.
std::size_t end_of_field(std::string_view line, std::size_t begin, char separator) {
  const std::string_view separators = separator == ' ' ? " \t" : std::string_view(&separator, 1);
  std::size_t i = begin;
  while (i < line.size() && line[i] == ' ') ++i;
  if (i < line.size() && line[i] == '"') {
    const std::size_t close = line.find('"', i + 1);
    if (close != std::string_view::npos) i = close;
  }
  return std::min(line.find_first_of(separators, i), line.size());
}

}  // namespace

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') line = trimmed_blanks(line);
  for (std::size_t begin = 0; fields.size() <= most_columns;) {
    const std::size_t end = end_of_field(line, begin, separator);
    fields.push_back(line.substr(begin, end - begin));
    if (end == line.size()) return;
    begin = end + 1;
    if (separator == ' ') begin = line.find_first_not_of(" \t", begin);
  }
}

bool leaves_quote_open(std::string_view line, char separator) {
  for (std::size_t begin = 0; begin < line.size();) {
    const std::size_t first = line.find_first_not_of(" \t", begin);
    if (first == std::string_view::npos) return false;
    if (line[first] == '"' && line.find('"', first + 1) == std::string_view::npos) return true;
    begin = end_of_field(line, begin, separator) + 1;
  }
  return false;
}

bool is_remark(std::string_view line, char separator) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return false;
  line.remove_prefix(first);
  return line[0] == '#' || line[0] == '%' || line.starts_with("//") ||
         (line[0] == ';' && separator != ';');
}

Result<CsvLayout> infer_layout(std::string_view head, bool is_whole_text) {
  if (is_blank(head) && is_whole_text)
    return Error{Errc::too_few_samples, "is empty: expected a table of numbers"};
  if (looks_binary(head))
    return Error{Errc::corrupt,
                 "is binary, and no format that is known: expected a table of text, or a format "
                 "that docs/formats.md lists"};
  CsvLayout layout;
  if (head.find('\n') == std::string_view::npos && head.find('\r') != std::string_view::npos)
    layout.line_end = '\r';
  const auto lines = complete_lines(head, layout.line_end, is_whole_text);
  const auto given = lines.empty() ? std::nullopt : separator_line(lines.front().text);
  Dialect dialect = find_dialect(lines, given);
  if (dialect.width > most_columns)
    return Error{Errc::corrupt,
                 "has more than " + std::to_string(most_columns) + " columns: no table"};
  layout.separator = dialect.separator;
  layout.point = dialect.point;
  layout.is_grouped = dialect.is_grouped;
  layout.trailing_separator = dialect.trailing;
  layout.columns = std::move(dialect.columns);
  if (!place_rows(lines, layout))
    return Error{
        Errc::too_few_samples,
        "no row of numbers in its first " + std::to_string(lines.size()) +
            " lines: expected a table, columns separated by comma, semicolon, tab or blank"};
  return layout;
}

}  // namespace proofmass::io
