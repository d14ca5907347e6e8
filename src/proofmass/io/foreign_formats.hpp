#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Whether a file is of a format that is known by its first bytes but not read.
[[nodiscard]] bool claims_foreign(std::string_view head, std::string_view file_name);

/// Says which format it is and what to do. Errors: unsupported, always.
[[nodiscard]] Result<std::unique_ptr<TableFile>> refuse_foreign(std::unique_ptr<PeekSource> source,
                                                                const ReadOptions& options);

}  // namespace proofmass::io
