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

/// What a reader knows of a recording besides its values.
struct RawHead {
  Recording recording;                ///< format, channels without values, first_line, notes so far
  std::optional<StampColumn> stamps;  ///< without values; its origin holds once a row was read
  std::optional<double> rate_hz;      ///< if the file says
  std::optional<std::int64_t> start_ns;
  std::optional<std::uint64_t> rows;  ///< about how many, if known beforehand
};

/// Rows as a reader hands them over: nothing is mended yet, no unit inferred.
struct RawRows {
  std::vector<std::vector<double>> channels;
  std::vector<double> stamps;  ///< less the origin; empty if there is no such column
};

/// A recording as it comes out of a file, a piece at a time.
class RecordingReader {
 public:
  RecordingReader() = default;
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;
  virtual ~RecordingReader() = default;

  [[nodiscard]] virtual const RawHead& head() const = 0;
  /// Puts the next rows in place of those in `rows`: about `most` of them; none only at the end.
  [[nodiscard]] virtual Status next(std::size_t most, RawRows& rows) = 0;
  /// Adds to the recording what is known once all rows are read: notes, labels. A column that holds
  /// words only, and no channel, is taken out of the channels.
  virtual void finish(Recording& recording) = 0;
  [[nodiscard]] virtual double fraction_read() const = 0;
};

/// Channels of a table's columns: the time is the one that --time names, else what the format
/// declares, else by name or unit; columns without names are called as those of a CSV without a
/// header, the first being the time in seconds if it ascends.
/// Errors: those of the first rows; invalid_argument (no column called as --time says),
/// too_few_samples (no row).
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> recording_reader_of(
    std::unique_ptr<TableReader> table, const ReadOptions& options);

}  // namespace proofmass::io
