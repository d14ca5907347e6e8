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

/// What the user knows better than the file.
struct ReadOptions {
  std::optional<double> rate_hz{};      ///< sample rate; stamps of the file are then not used
  std::optional<Unit> unit{};           ///< of the accelerometer channels, whatever the header says
  std::string time_channel{};           ///< name of the time column; empty: find it
  std::vector<std::string> channels{};  ///< keep these only, in the order of the file; empty: all
  std::vector<std::string> variables{};  ///< of a file of named arrays; empty: choose
  std::string duckdb_library{};  ///< path of libduckdb.so, which reads Parquet; empty: the system's
  /// Brings the samples onto an even grid, and several tables onto one; none: as they were taken.
  std::optional<signal::ResampleOptions> resample{};
  /// Each channel of a row was sampled so much behind the one before; undone if not 0.
  double skew_s = 0.0;
  Progress progress{};  ///< told the fraction of the file read; may be empty
};

/// Reads a recording: CSV and TSV of any dialect, .npy (a table of samples × channels, or a
/// structured array), MAT of any version, or HDF5, plain or compressed by gzip or xz. The bytes
/// decide what a file is, its name only where they do not. What was found, inferred or mended is
/// told in Recording::notes: the separator, the header's line, where the units and the time base
/// come from, rows that were short, stamps that were corrupt. Values come back as recorded, NaN
/// where the file has no number. `path` "-" is standard input.
/// A compressed file that breaks off yields what was read before, with a note of Severity::bad.
/// Errors: unreadable (no such file, no permission, a directory), corrupt (not a table of numbers;
/// damaged headers), unsupported (a format that is known but not read), too_few_samples (no row of
/// numbers), invalid_argument (a channel, variable or time column that is not there; a rate not
/// above zero). Each names the file and, where there is one, the line or byte.
/// Cost: one pass; memory at the peak 1.02 to 1.15 × the table's doubles, the time column counted
/// although it is dropped where it turns out to be uniform; of MAT the file's bytes besides. HDF5
/// is unpacked in a child process.
[[nodiscard]] Result<Recording> read_recording(const std::string& path, const ReadOptions& options);

/// The same for bytes that are in memory already; `name` stands for the file in errors and notes.
[[nodiscard]] Result<Recording> read_recording(std::span<const std::byte> bytes,
                                               const std::string& name,
                                               const ReadOptions& options);

}  // namespace proofmass::io
