#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::parquet {

/// By the first bytes, "PAR1".
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens Parquet by DuckDB's library (ReadOptions::duckdb_library), which runs in a child process
/// with limits on memory and time and transfers one block of rows at a time. Numeric and timestamp
/// columns form the table; others are reported in a note.
/// Errors: unsupported (no such library), corrupt, too_few_samples (no numeric column), unreadable.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::parquet
