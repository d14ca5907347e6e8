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
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// What a format of arrays that is read at once has read: equally long columns, and what they are
/// called.
struct ArrayColumns {
  std::vector<std::vector<double>> values;
  std::vector<std::string> headings;  ///< one a column, units included; empty: none has a name
  std::optional<double> rate_hz;      ///< if the file says
  /// The clock's time where the column of times says 0, or of row 0 where there is none.
  std::optional<std::int64_t> start_ns;
};

/// The columns as a recording that is read. `recording` has its format and notes so far.
/// Errors: as name_columns(), and too_few_samples (no column).
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> recording_reader_of(
    ArrayColumns columns, Recording recording, const ReadOptions& options);

}  // namespace proofmass::io
