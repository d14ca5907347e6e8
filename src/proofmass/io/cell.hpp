#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// Content of one field of a text table.
enum class CellKind {
  number,   ///< a finite number or an infinity
  missing,  ///< empty, or a word for missing: NaN, NULL, #N/A, …
  text,
};

struct Cell {
  CellKind kind = CellKind::missing;
  double value = 0.0;  ///< NaN unless a number
};

/// `text` without surrounding blanks and one pair of quotes.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// True if a spreadsheet would interpret a text as a formula: it begins with '=', '+', '-', '@', a
/// tab or a carriage return.
[[nodiscard]] bool is_formula(std::string_view text);

/// A text without the apostrophe that prevents it from being a formula.
[[nodiscard]] std::string_view without_guard(std::string_view text);

/// Parses a field; `point` is the decimal mark. Hexadecimal is not supported. Thousands may be
/// separated if `is_grouped`.
[[nodiscard]] Cell read_cell(std::string_view field, char point, bool is_grouped = false);

/// A number with separated thousands ("1,234.5", "1'234", "1 234 567"), without the separators: one
/// to three digits that do not begin with 0, then groups of three after the same separator, which
/// is an apostrophe, an underscore, any blank, or the one of comma and point that is not `point`.
/// Empty for any other field.
[[nodiscard]] std::string without_grouping(std::string_view field, char point);

}  // namespace proofmass::io
