#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/csv_layout.hpp"

namespace proofmass::io {

/// A column's heading taken apart.
struct ColumnLabel {
  std::string name;
  Unit unit;  ///< Quantity::unknown where the heading names none
};

/// Reads one heading: "Acc X (m/s^2)", "acc_x [g]", "Acc X, g", "acc_x_g", "Gyr_X_deg_s".
[[nodiscard]] ColumnLabel read_label(std::string_view heading);

/// How surely a heading is that of the time column: 0 not at all, 1 by its unit alone, 4 certainly.
[[nodiscard]] int likeness_to_time(const ColumnLabel& label);

/// Gives columns without a name one by their place, and a number to those of the same name.
void complete_names(std::vector<ColumnLabel>& labels, std::vector<Note>& notes);

/// What the lines before the rows say about the columns.
struct CsvHeader {
  std::vector<ColumnLabel> labels;  ///< one a column, names unique
  bool found = false;               ///< false: the names are made up
  std::size_t line = 0;             ///< of the lowest line of it
  std::optional<double> rate_hz;    ///< "SampleRate, 64,Hz"
  /// Time since 1970 at which stamps that count the seconds from a start are zero.
  std::optional<std::int64_t> zero_ns;
  std::vector<Note> notes;
};

/// Finds the header in one row or two (groups above, axes below), in a remark, with or without a
/// row of units below it. Without one, columns are called x, y, z where there are three beside an
/// ascending first, which is "time"; else "column 1", …
[[nodiscard]] CsvHeader read_header(const CsvLayout& layout);

/// Why the rows behind a line of words between the rows cannot be read as those before it: it is a
/// second header (or row of units) with another unit, or with the columns in another order. Nothing
/// where it is neither, or says the same.
[[nodiscard]] std::optional<std::string> contradiction(const CsvHeader& header,
                                                       const CsvLayout& layout,
                                                       const PreambleLine& line);

}  // namespace proofmass::io
