#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "proofmass/io/csv/layout.hpp"

// The separator and the decimal mark of a text table, from its lines.
namespace proofmass::io {

/// A line of a file, and where it is.
struct Line {
  std::string_view text;
  std::size_t offset = 0;
  std::size_t number = 1;
};

/// Nothing but blanks, tabs, CR and NUL.
[[nodiscard]] bool is_blank(std::string_view line);

/// Number of fields, not counting an empty last one.
[[nodiscard]] std::size_t width_of(const std::vector<std::string_view>& fields);

struct Dialect {
  char separator = ',';  ///< ' ' means any run of blanks and tabs
  char point = '.';
  bool is_grouped = false;  ///< numbers may have separated thousands
  std::size_t width = 0;    ///< width of most lines
  bool trailing = false;    ///< most lines of that width end in a separator
  std::vector<ColumnKind> columns;
};

/// The way to split the lines that makes most of them rows of one width with most numbers; `given`
/// is the separator that the file states.
[[nodiscard]] Dialect find_dialect(const std::vector<Line>& lines, std::optional<char> given);

}  // namespace proofmass::io
