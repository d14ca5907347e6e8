#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Decides by the first bytes.
[[nodiscard]] bool claims_zip(std::string_view head, std::string_view file_name);

/// The recordings in a zip archive, as open_tables_in() finds them.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_zip_tables(std::unique_ptr<PeekSource> source,
                                                                 const ReadOptions& options);

}  // namespace proofmass::io
