#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/framing/framing.hpp"
#include "proofmass/io/csv/header.hpp"

namespace proofmass::acquire {

/// A field of a row, before its role is determined.
struct RowField {
  std::string heading{};  ///< as received: "t_us"
  io::ColumnLabel label{};
  int bits = 0;              ///< width of an integer; 0: not an integer, or unknown
  bool is_figures = true;    ///< false: words, which are not a channel
  bool is_calendar = false;  ///< dates, converted to ticks in seconds since 1970
};

/// Information on the rows before the columns are determined.
struct RowEvidence {
  std::vector<RowField> fields{};
  bool has_names = true;                     ///< false: the names are our own
  std::vector<std::vector<double>> first{};  ///< the first rows of each field, if any
  std::vector<std::int64_t> host_ns{};       ///< arrival of each of them
};

/// The decisions and their notes.
struct DecidedPlan {
  RowPlan plan{};
  std::optional<std::size_t> clock_field{};
  std::vector<Note> notes{};
  std::vector<std::pair<std::string, std::string>> settings{};
};

/// Determines the clock field, the row counter, and names and units of the channels. Errors:
/// invalid_argument (an option names a column that is not in the rows, an invalid unit or factor, a
/// clock of unknown unit).
[[nodiscard]] Result<DecidedPlan> decide_plan(const RowEvidence& rows,
                                              const FramingOptions& options);

}  // namespace proofmass::acquire
