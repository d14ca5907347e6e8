#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/lvm_header.hpp"

namespace proofmass::io {

/// When the channels of a table were sampled in one segment.
struct LvmClock {
  std::optional<std::int64_t> start_ns;
  double x0 = 0.0;
  double delta_x = 0.0;
  double delta_half_unit = 0.0;
};

/// The rows of one segment.
struct LvmRows {
  std::uint64_t offset = 0;  ///< of the first
  std::size_t line = 0;      ///< of the first
  std::size_t count = 0;
  std::size_t claimed = 0;  ///< as the header says, of the longest channel
  LvmClock clock;
};

/// Channels that were sampled together: of one Delta_X, through all segments that have them.
struct LvmTable {
  std::string name;
  std::vector<LvmChannel> channels;  ///< as the first segment has them
  std::optional<std::size_t> x_column;
  bool x_is_time = true;
  std::string x_heading;
  std::vector<LvmRows> segments;
  std::size_t columns_in_file = 0;  ///< of the widest row that is looked at, comments not counted
  std::vector<Note> notes;

  [[nodiscard]] std::uint64_t rows() const;
};

/// A segment's channels as tables without rows: those of one Delta_X that began together. Where
/// there are several their names say their rates.
[[nodiscard]] std::vector<LvmTable> tables_of(const LvmSegment& segment, LvmX x);

/// Whether a line between headers is a row of figures; blank ones and words are none.
[[nodiscard]] bool is_lvm_row(std::string_view line, const LvmFile& file);

}  // namespace proofmass::io
