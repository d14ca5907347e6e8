#pragma once

#include <memory>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// A text table of any dialect, starting at the current position of `source`. Errors:
/// too_few_samples (no row of numbers), corrupt (no table), invalid_argument.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> csv_reader(
    std::unique_ptr<PeekSource> source, const ReadOptions& options);

/// The same as a file with one table.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_csv(std::unique_ptr<PeekSource> source,
                                                          const ReadOptions& options);

}  // namespace proofmass::io
