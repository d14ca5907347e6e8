#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/progress.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/signal/resample.hpp"

namespace proofmass::io {

/// Settings of the user that override the file.
struct ReadOptions {
  std::optional<double> rate_hz{};       ///< sample rate; stamps of the file are then ignored
  std::optional<Unit> unit{};            ///< accelerometers' unit, overriding the header
  std::string time_channel{};            ///< name of the time column; empty: detect
  std::vector<std::string> channels{};   ///< keep only these, in the order of the file; empty: all
  std::vector<std::string> variables{};  ///< variables of a file of named arrays; empty: automatic
  std::string duckdb_library{};          ///< path of libduckdb.so, for Parquet; empty: the system's
  /// Resamples to an even grid, and joins several tables on one; empty: samples as recorded.
  std::optional<signal::ResampleOptions> resample{};
  /// Delay of each channel of a row after the previous one; corrected if not 0.
  double skew_s = 0.0;
  Progress progress{};  ///< receives the fraction of the file read; may be empty
};

/// Reads a recording: CSV and TSV of any dialect, .npy (a table of samples × channels, or a
/// structured array), MAT of any version, or HDF5, plain or compressed by gzip or xz.
///
/// - The format is determined from the bytes, and from the name only if they are ambiguous.
/// - Everything detected, inferred or corrected is reported in Recording::notes: the separator, the
///   header's line, the source of units and time base, short rows, corrupt stamps.
/// - Values are returned as recorded, NaN where the file has no number.
/// - A truncated compressed file returns the data before the end, with a note of Severity::bad.
/// - `path` "-" is standard input.
///
/// Errors: unreadable (no such file, no permission, a directory), corrupt (not a table of numbers;
/// damaged headers), unsupported (a known format that is not read), too_few_samples (no row of
/// numbers), invalid_argument (a channel, variable or time column that does not exist; a rate not
/// above zero). Each names the file and, if applicable, the line or byte.
/// Cost: one pass; peak memory 1.02 to 1.15 × the table's doubles, including the time column, which
/// is dropped if it turns out to be uniform; for MAT the file's bytes in addition. HDF5 is decoded
/// in a child process.
[[nodiscard]] Result<Recording> read_recording(const std::string& path, const ReadOptions& options);

/// The same for bytes in memory; `name` is the file name in errors and notes.
[[nodiscard]] Result<Recording> read_recording(std::span<const std::byte> bytes,
                                               const std::string& name,
                                               const ReadOptions& options);

}  // namespace proofmass::io
