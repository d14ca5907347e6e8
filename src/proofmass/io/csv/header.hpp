#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/csv/layout.hpp"

namespace proofmass::io {

/// A column's heading, parsed.
struct ColumnLabel {
  std::string name;
  Unit unit;  ///< Quantity::unknown if the heading has none
};

/// Parses one heading: "Acc X (m/s^2)", "acc_x [g]", "Acc X, g", "acc_x_g", "Gyr_X_deg_s".
[[nodiscard]] ColumnLabel read_label(std::string_view heading);

/// Confidence that a heading is that of the time column: 0 none, 1 by its unit alone, 4 certain.
[[nodiscard]] int likeness_to_time(const ColumnLabel& label);

/// Names unnamed columns by their position, and appends numbers to equal names.
void complete_names(std::vector<ColumnLabel>& labels, std::vector<Note>& notes);

/// Information on the columns from the lines before the rows.
struct CsvHeader {
  std::vector<ColumnLabel> labels;  ///< one per column, unique names
  bool found = false;               ///< false: the names are generated
  std::size_t line = 0;             ///< its last line
  std::optional<double> rate_hz;    ///< "SampleRate, 64,Hz"
  /// Time since 1970 of zero of stamps that count seconds from a start.
  std::optional<std::int64_t> zero_ns;
  std::vector<Note> notes;
};

/// Finds the header in one row or two (groups above, axes below), in a comment, with or without a
/// row of units below it. Without a header, the columns are x, y, z if there are three after an
/// increasing first column, which is "time"; else "column 1", …
[[nodiscard]] CsvHeader read_header(const CsvLayout& layout);

/// The reason why the rows after a line of words between the rows cannot be read like those before
/// it: it is a second header (or row of units) with another unit, or with the columns in another
/// order. nullopt if it is neither, or agrees with the first.
[[nodiscard]] std::optional<std::string> contradiction(const CsvHeader& header,
                                                       const CsvLayout& layout,
                                                       const PreambleLine& line);

}  // namespace proofmass::io
