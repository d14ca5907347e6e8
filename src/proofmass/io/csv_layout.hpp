#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// What the fields of a column are, by the majority of the rows looked at.
enum class ColumnKind : unsigned char {
  number,
  blank,  ///< nothing in any of them
  text,
  date,         ///< a date alone
  clock,        ///< a date with a time of day
  time_of_day,  ///< a time of day alone
};

/// A line before the rows of numbers.
struct PreambleLine {
  std::size_t number = 0;  ///< 1 = first of the file
  bool is_comment = false;
  std::string text;  ///< less the comment's mark
};

/// How a text lays out its table.
struct CsvLayout {
  char separator = ',';  ///< ' ' stands for any run of blanks and tabs
  char point = '.';
  bool is_grouped = false;          ///< figures may have their thousands separated
  char line_end = '\n';             ///< '\r' in files that know no other
  bool trailing_separator = false;  ///< rows end in a separator
  std::vector<ColumnKind> columns;
  /// Of columns of text, the first field among the rows looked at that has the shape of a figure,
  /// if most have: "(0.5)", "5 %".
  std::vector<std::string> odd_figures;
  std::size_t data_offset = 0;         ///< byte at which the first row of numbers begins
  std::size_t first_line = 1;          ///< its line
  std::vector<PreambleLine> preamble;  ///< the lines before it that are not blank
  double bytes_per_row = 0.0;          ///< mean over the rows looked at
  bool first_ascends = false;  ///< the first column's figures ascend over the rows looked at
};

/// More columns than any instrument has: beyond it a file is no table.
inline constexpr std::size_t most_columns = 16'384;

/// Takes a line apart; quotes hold separators together. Views into `line`, blanks and quotes left
/// on.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Whether a line is a remark: '#', '%', "//", or ';' where that is not the separator.
[[nodiscard]] bool is_remark(std::string_view line, char separator);

/// Whether a field begins with a quote that this line does not close: its text goes on below.
[[nodiscard]] bool leaves_quote_open(std::string_view line, char separator);

/// Finds separator, decimal mark, columns and the first row of numbers from the beginning of a
/// text: the separator and mark under which most fields of equally wide rows are numbers.
/// Errors: too_few_samples (no row of numbers, though a header), corrupt (no table; binary).
[[nodiscard]] Result<CsvLayout> infer_layout(std::string_view head, bool is_whole_text);

}  // namespace proofmass::io
