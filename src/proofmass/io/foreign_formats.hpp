#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// True if a file is of a format that is recognised by its first bytes but not supported.
[[nodiscard]] bool claims_foreign(std::string_view head, std::string_view file_name);

/// Names the format and what to do. Errors: unsupported, always.
[[nodiscard]] Result<std::unique_ptr<TableFile>> refuse_foreign(std::unique_ptr<PeekSource> source,
                                                                const ReadOptions& options);

}  // namespace proofmass::io
