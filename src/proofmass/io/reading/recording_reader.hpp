#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// Information on a recording without its values.
struct RawHead {
  Recording recording;                ///< format, channels without values, first_line, notes so far
  std::optional<StampColumn> stamps;  ///< without values; its origin is valid once a row was read
  std::optional<double> rate_hz;      ///< if the file states it
  std::optional<std::int64_t> start_ns;
  std::optional<std::uint64_t> rows;  ///< approximate number, if known in advance
};

/// Rows as returned by a reader: not corrected, units not inferred.
struct RawRows {
  std::vector<std::vector<double>> channels;
  std::vector<double> stamps;  ///< minus the origin; empty if there is no such column
};

/// A recording read from a file in blocks.
class RecordingReader {
 public:
  RecordingReader() = default;
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;
  virtual ~RecordingReader() = default;

  [[nodiscard]] virtual const RawHead& head() const = 0;
  /// Replaces `rows` by about `most` next rows; none only at the end.
  [[nodiscard]] virtual Status next(std::size_t most, RawRows& rows) = 0;
  /// Adds the information known once all rows are read: notes, labels. Removes text columns from
  /// the channels.
  virtual void finish(Recording& recording) = 0;
  [[nodiscard]] virtual double fraction_read() const = 0;
};

/// Channels from a table's columns. The time is the column given by --time, else the one declared
/// by the format, else by name or unit; unnamed columns are named as in a CSV without a header, the
/// first being the time in seconds if it increases.
/// Errors: those of the first rows; invalid_argument (no column with the name given by --time),
/// too_few_samples (no row).
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> recording_reader_of(
    std::unique_ptr<TableReader> table, const ReadOptions& options);

}  // namespace proofmass::io
