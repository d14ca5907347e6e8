#pragma once

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Reads a table of text of any dialect from where `source` stands.
[[nodiscard]] Result<Recording> read_csv(PeekSource& source, const ReadOptions& options);

}  // namespace proofmass::io
