#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::tdms {

/// "TDSm", or "TDSh" of an index file, which is then rejected with a message.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens a TDMS file of LabVIEW, of either byte order, interleaved or not, including DAQmx raw
/// data. A table consists of the channels of one group with the same rate, start and length; groups
/// are never joined.
/// Errors: corrupt (no segment), unsupported (an index file), too_few_samples (no numeric channel).
/// Cost: one pass over the lead-ins and metadata; 40 bytes of memory for each segment that differs
/// from the previous one.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::tdms
