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
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// One of the tables that a file holds: columns that were sampled together.
struct TableSummary {
  std::string name;  ///< as --variable takes it: "Accelerometer", "/imu/data"; may be empty if lone
  std::vector<std::string> headings;  ///< unit included
  std::optional<std::uint64_t> rows;  ///< if known
  std::optional<double> rate_hz;      ///< if known
  bool rows_are_guessed = false;      ///< good to choose a table by, not to be told
  bool is_derived = false;            ///< worked out of another table, which goes before it
};

/// An open file, or folder, of one table or several, each with a time base of its own.
class TableFile {
 public:
  TableFile() = default;
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;
  virtual ~TableFile() = default;

  [[nodiscard]] virtual std::span<const TableSummary> tables() const = 0;
  /// Opens one of them. What else there is in the file is told by read_recording(), not here.
  /// Readers may outlive the file, and one may be opened after the other.
  [[nodiscard]] virtual Result<std::unique_ptr<RecordingReader>> open(
      std::size_t table, const ReadOptions& options) = 0;
};

/// A file of one table that can be opened once.
[[nodiscard]] std::unique_ptr<TableFile> only_table(std::unique_ptr<RecordingReader> reader);

/// Which of the tables make the recording: those that ReadOptions::variables name (exactly, then
/// ignoring case, then by the end of a path), else the one with accelerations, of several the one
/// with most rows; what else there is, is told in a note.
/// Errors: too_few_samples (no table), invalid_argument (none of a name asked for).
[[nodiscard]] Result<std::vector<std::size_t>> choose_table(std::span<const TableSummary> tables,
                                                            const ReadOptions& options,
                                                            std::vector<Note>& notes);

}  // namespace proofmass::io
