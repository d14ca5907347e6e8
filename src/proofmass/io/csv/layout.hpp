#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Type of a column's fields, by the majority of the rows examined.
enum class ColumnKind : unsigned char {
  number,
  blank,  ///< empty in all rows
  text,
  date,         ///< a date alone
  clock,        ///< a date with a time of day
  time_of_day,  ///< a time of day alone
};

/// A line before the rows of numbers.
struct PreambleLine {
  std::size_t number = 0;  ///< 1 = first of the file
  bool is_comment = false;
  std::string text;  ///< without the comment mark
};

/// Layout of a text table.
struct CsvLayout {
  char separator = ',';  ///< ' ' means any run of blanks and tabs
  char point = '.';
  bool is_grouped = false;          ///< numbers may have separated thousands
  char line_end = '\n';             ///< '\r' in files that use no other
  bool trailing_separator = false;  ///< rows end in a separator
  std::vector<ColumnKind> columns;
  /// For text columns, the first field among the rows examined that resembles a number, if most do:
  /// "(0.5)", "5 %".
  std::vector<std::string> odd_figures;
  std::size_t data_offset = 0;         ///< first byte of the first row of numbers
  std::size_t first_line = 1;          ///< its line
  std::vector<PreambleLine> preamble;  ///< the non-blank lines before it
  double bytes_per_row = 0.0;          ///< mean over the rows examined
  bool first_ascends = false;          ///< the first column increases over the rows examined
};

/// More columns than any instrument has: a file with more is not a table.
inline constexpr std::size_t most_columns = 16'384;

/// Splits a line; separators within quotes are ignored. Views into `line`, including blanks and
/// quotes.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// True if a line is a comment: '#', '%', "//", or ';' if that is not the separator.
[[nodiscard]] bool is_remark(std::string_view line, char separator);

/// True if a field begins with a quote that is not closed in this line: its text continues below.
[[nodiscard]] bool leaves_quote_open(std::string_view line, char separator);

/// Determines separator, decimal mark, columns and the first row of numbers from the beginning of a
/// text: the separator and mark for which most fields of equally wide rows are numbers.
/// Errors: too_few_samples (a header but no row of numbers), corrupt (no table; binary).
[[nodiscard]] Result<CsvLayout> infer_layout(std::string_view head, bool is_whole_text);

}  // namespace proofmass::io
