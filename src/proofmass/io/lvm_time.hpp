#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/lvm_segments.hpp"

namespace proofmass::io {

/// When the rows of a table were taken.
struct LvmTiming {
  /// Of all rows, where one step fits them; nullopt: each row has a time of its own.
  std::optional<double> rate_hz;
  std::optional<std::int64_t> start_ns;  ///< what starts_s count from
  std::vector<double> starts_s;          ///< of each segment's row 0, or of its X value 0
  std::vector<double> steps_s;           ///< of each segment, where rows have no X value
  std::vector<Note> notes;
};

/// Segments begin at their Date and Time + X0; X0 counts from the first segment's where only that
/// continues the segment before. Delta_X is written with few digits: where segments follow each
/// other within its rounding, the step is what their starts say.
[[nodiscard]] LvmTiming time_lvm(const LvmTable& table);

}  // namespace proofmass::io
