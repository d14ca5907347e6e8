#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

[[nodiscard]] bool claims_npy(std::string_view head, std::string_view file_name);

/// Opens a NumPy array: 1-D is one channel; 2-D is samples × channels, or channels × samples if
/// there are far more columns than rows; a structured array's fields are the channels. Column 0 of
/// a plain 2-D array is the time in seconds if it increases.
/// Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays".
/// Errors: corrupt, unsupported (text, objects, complex numbers), too_few_samples, unreadable.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_npy(std::unique_ptr<PeekSource> source,
                                                          const ReadOptions& options);

}  // namespace proofmass::io
