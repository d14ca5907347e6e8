#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

[[nodiscard]] bool claims_mcap(std::string_view head, std::string_view file_name);

/// Opens an MCAP file, closed properly or cut off. A table is a topic whose messages are blocks of
/// samples as mcap_writer() writes them, ROS 2 (cdr) or ROS 1 messages whose schema the file holds,
/// or JSON; other encodings are told. Rows come in the order of the file.
/// Source: MCAP format specification, version 0.
/// Errors: corrupt (no record can be read), unsupported (no topic of an encoding that is read),
/// too_few_samples (no message).
/// Cost: one pass over the records up to the first message of every topic where the summary is
/// whole, over all of them where it is not; memory of one chunk, which may be 1 GiB unpacked.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_mcap(std::unique_ptr<PeekSource> source,
                                                           const ReadOptions& options);

}  // namespace proofmass::io
