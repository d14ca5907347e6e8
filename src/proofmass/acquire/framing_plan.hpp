#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/framing.hpp"
#include "proofmass/io/csv_header.hpp"

namespace proofmass::acquire {

/// A field of a row, before it is decided what it is for.
struct RowField {
  std::string heading{};  ///< as it came: "t_us"
  io::ColumnLabel label{};
  int bits = 0;              ///< width of a whole number; 0: of none, or unknown
  bool is_figures = true;    ///< false: words, which are no channel
  bool is_calendar = false;  ///< dates, which give ticks in seconds since 1970
};

/// What is known of the rows before the columns are decided.
struct RowEvidence {
  std::vector<RowField> fields{};
  bool has_names = true;                     ///< false: the names are no one's but ours
  std::vector<std::vector<double>> first{};  ///< rows of each field, where there are any yet
  std::vector<std::int64_t> host_ns{};       ///< of each of them
};

/// What was decided and what a person should know of it.
struct DecidedPlan {
  RowPlan plan{};
  std::optional<std::size_t> clock_field{};
  std::vector<Note> notes{};
  std::vector<std::pair<std::string, std::string>> settings{};
};

/// Decides which field is the clock, which counts rows, and names and units of the channels.
/// Errors: invalid_argument (a column that the options name and the rows do not have, a unit or
/// factor that is none, a clock whose unit nobody says).
[[nodiscard]] Result<DecidedPlan> decide_plan(const RowEvidence& rows,
                                              const FramingOptions& options);

}  // namespace proofmass::acquire
