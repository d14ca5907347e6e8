#pragma once

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

/// Reads a field of any shape; `point` is the decimal mark. No hexadecimals.
[[nodiscard]] Cell read_cell(std::string_view field, char point);

}  // namespace proofmass::io
