#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Whether a file is MAT of version 4, or 5 to 7, by its first bytes.
[[nodiscard]] bool claims_mat(std::string_view head, std::string_view file_name);

/// MATLAB's files of versions 4 to 7: of the arrays of numbers in them, also those inside
/// structs and cells, the largest that is a table of samples, with the vectors of its length beside
/// it, or those that ReadOptions::variables names. The columns of a matrix are called by their
/// place, and the first is the time in seconds if it ascends and nothing else is the time; vectors
/// are called as in the file. Notes tell what was read and what else there is.
/// Errors: corrupt (naming the byte; a file that breaks off too), unsupported, too_few_samples,
/// invalid_argument.
/// Cost: the file's bytes in memory beside the columns; compressed variables are unpacked twice.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_mat(std::unique_ptr<PeekSource> source,
                                                          const ReadOptions& options);

}  // namespace proofmass::io
