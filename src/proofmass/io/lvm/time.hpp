#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/lvm/segments.hpp"

namespace proofmass::io::lvm {

/// Times of the rows of a table.
struct Timing {
  /// Common rate of all rows, if one period fits them; nullopt: each row has its own time.
  std::optional<double> rate_hz;
  std::optional<std::int64_t> start_ns;  ///< origin of starts_s
  std::vector<double> starts_s;          ///< start of each segment: its row 0, or its X value 0
  std::vector<double> steps_s;           ///< period of each segment, if rows have no X value
  std::vector<Note> notes;
};

/// Segments begin at their Date and Time + X0; X0 counts from the first segment's if only that
/// continues the previous segment. Delta_X is written with few digits: if segments are consecutive
/// within its rounding, the period is determined from their starts.
[[nodiscard]] Timing timing_of(const Table& table);

}  // namespace proofmass::io::lvm
