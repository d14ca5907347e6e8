#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/column_names.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// Result of reading an array format in one step: columns of equal length, and their names.
struct ArrayColumns {
  std::vector<std::vector<double>> values;
  std::vector<std::string> headings;  ///< one per column, with units; empty: none has a name
  std::optional<double> rate_hz;      ///< if the file states it
  /// Clock time at zero of the time column, or at row 0 if there is none.
  std::optional<std::int64_t> start_ns;
};

/// The columns as a recording reader. `recording` has its format and notes so far.
/// Errors: as name_columns(), and too_few_samples (no column).
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> recording_reader_of(
    ArrayColumns columns, Recording recording, const ReadOptions& options);

}  // namespace proofmass::io
