#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/lvm/header.hpp"

namespace proofmass::io::lvm {

/// Sampling times of a table's channels in one segment.
struct Clock {
  std::optional<std::int64_t> start_ns;
  double x0 = 0.0;
  double delta_x = 0.0;
  double delta_half_unit = 0.0;
};

/// The rows of one segment.
struct Rows {
  std::uint64_t offset = 0;  ///< offset of the first row
  std::size_t line = 0;      ///< line of the first row
  std::size_t count = 0;
  std::size_t claimed = 0;  ///< according to the header, for the longest channel
  Clock clock;
};

/// Channels sampled together: with one Delta_X, through all segments that have them.
struct Table {
  std::string name;
  std::vector<Channel> channels;  ///< as in the first segment
  std::optional<std::size_t> x_column;
  bool x_is_time = true;
  std::string x_heading;
  std::vector<Rows> segments;
  std::size_t columns_in_file = 0;  ///< width of the widest row examined, without comments
  std::vector<Note> notes;

  [[nodiscard]] std::uint64_t rows() const;
};

/// A segment's channels as tables without rows: those with one Delta_X and a common start. If there
/// are several, their names contain their rates.
[[nodiscard]] std::vector<Table> tables_of(const Segment& segment, XColumns x);

/// True if a line between headers is a row of numbers; blank lines and words are not.
[[nodiscard]] bool is_data_row(std::string_view line, const File& file);

}  // namespace proofmass::io::lvm
