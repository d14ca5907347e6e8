#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// What stands in one field of a table of text.
enum class CellKind {
  number,   ///< a figure, an infinity
  missing,  ///< nothing, or a word for nothing: NaN, NULL, #N/A, …
  text,
};

struct Cell {
  CellKind kind = CellKind::missing;
  double value = 0.0;  ///< NaN unless a number
};

/// `text` less blanks and a pair of quotes around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Whether a spreadsheet takes a text for a formula: it begins with '=', '+', '-', '@', a tab or a
/// carriage return.
[[nodiscard]] bool is_formula(std::string_view text);

/// A text less the apostrophe by which it was kept from being a formula.
[[nodiscard]] std::string_view without_guard(std::string_view text);

/// Reads a field of any shape; `point` is the decimal mark. No hexadecimals. Thousands may be
/// separated where `is_grouped`.
[[nodiscard]] Cell read_cell(std::string_view field, char point, bool is_grouped = false);

/// A figure with its thousands separated ("1,234.5", "1'234", "1 234 567"), without the separators:
/// one to three digits that do not begin with 0, then groups of three behind the same mark, which
/// is an apostrophe, a low line, any blank, or the one of comma and point that is not `point`.
/// Empty where the field is anything else.
[[nodiscard]] std::string without_grouping(std::string_view field, char point);

}  // namespace proofmass::io
