#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/positions/text_lines.hpp"

namespace proofmass::io {

/// Unit of a column according to its heading.
enum class Counts { unsaid, seconds, samples };

/// The column of one end of the intervals.
struct IntervalEdge {
  std::size_t column = 0;
  Counts counts = Counts::unsaid;
  double unit_s = 1.0;
};

/// Format of a list of intervals.
struct IntervalColumns {
  char separator = ',';
  char point = '.';
  bool has_header = false;
  IntervalEdge start, end;
  std::optional<std::size_t> label;
  std::optional<std::array<std::size_t, 3>> up;
  std::optional<std::size_t> angle;
  double angle_unit_rad = 1.0;

  [[nodiscard]] bool in_samples() const {
    return start.counts == Counts::samples || end.counts == Counts::samples;
  }
};

/// Determines separator, decimal mark and columns: from a header in the first line, or, if that
/// begins with two numbers, start, end and text.
/// Errors: corrupt (neither; seconds and samples in one list; a direction of fewer than three
/// components).
[[nodiscard]] Result<IntervalColumns> find_interval_columns(const std::vector<TextLine>& lines);

/// True if a field is a number, with either decimal mark.
[[nodiscard]] bool is_figure(const std::string& field);

/// A line's fields without blanks and quotes.
[[nodiscard]] std::vector<std::string> fields_of(const TextLine& line, char separator);

}  // namespace proofmass::io
