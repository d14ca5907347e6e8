#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::mcap {

[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens an MCAP file, closed properly or truncated. A table is a topic of blocks of samples as
/// written by mcap::create(), of ROS 2 (cdr) or ROS 1 messages whose schema is in the file, or of
/// JSON; other encodings are reported. Rows are in the order of the file.
/// Source: MCAP format specification, version 0.
/// Errors: corrupt (no record can be read), unsupported (no topic with a supported encoding),
/// too_few_samples (no message).
/// Cost: one pass over the records up to the first message of every topic if the summary is intact,
/// else over all of them; memory of one chunk, which may be 1 GiB decompressed.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::mcap
