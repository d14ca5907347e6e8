#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// One of the tables in a file: columns that were sampled together.
struct TableSummary {
  std::string name;  ///< as for --variable: "Accelerometer", "/imu/data"; may be empty for a single
                     ///< table
  std::vector<std::string> headings;  ///< with units
  std::optional<std::uint64_t> rows;  ///< if known
  std::optional<double> rate_hz;      ///< if known
  bool rows_are_guessed = false;      ///< accurate enough to select a table, not to be reported
  bool is_derived = false;            ///< computed from another table, which takes precedence
};

/// An open file or folder with one or more tables, each with its own time base.
class TableFile {
 public:
  TableFile() = default;
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;
  virtual ~TableFile() = default;

  [[nodiscard]] virtual std::span<const TableSummary> tables() const = 0;
  /// Opens one of them. The other contents of the file are reported by read_recording(), not here.
  /// Readers may outlive the file, and several may be opened in turn.
  [[nodiscard]] virtual Result<std::unique_ptr<RecordingReader>> open(
      std::size_t table, const ReadOptions& options) = 0;
};

/// A file with one table that can be opened once.
[[nodiscard]] std::unique_ptr<TableFile> only_table(std::unique_ptr<RecordingReader> reader);

/// Selects the tables of the recording: those named by ReadOptions::variables (exactly, then
/// ignoring case, then by the end of a path), else the one with accelerations, of several the one
/// with most rows; the others are reported in a note.
/// Errors: too_few_samples (no table), invalid_argument (no table of a requested name).
[[nodiscard]] Result<std::vector<std::size_t>> choose_table(std::span<const TableSummary> tables,
                                                            const ReadOptions& options,
                                                            std::vector<Note>& notes);

}  // namespace proofmass::io
