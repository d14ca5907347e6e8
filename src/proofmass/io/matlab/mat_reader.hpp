#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::matlab {

/// True if a file is MAT of version 4, or 5 to 7, by its first bytes.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// MATLAB's files of versions 4 to 7. Reads the largest numeric array that is a table of samples,
/// including those inside structs and cells, with the vectors of its length beside it; or those
/// named by ReadOptions::variables. The columns of a matrix are named by position, and the first is
/// the time in seconds if it increases and nothing else is the time; vectors are named as in the
/// file. Notes report what was read and the alternatives.
/// Errors: corrupt (naming the byte; also a truncated file), unsupported, too_few_samples,
/// invalid_argument.
/// Cost: the file's bytes in memory besides the columns; compressed variables are decompressed
/// twice.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::matlab
