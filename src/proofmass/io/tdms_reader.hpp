#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// "TDSm", or "TDSh" of an index file, which is then refused with a word.
[[nodiscard]] bool claims_tdms(std::string_view head, std::string_view file_name);

/// Opens a TDMS file of LabVIEW, of either byte order, interleaved or not, DAQmx raw data included.
/// A table is what one group holds of one rate, start and length; groups are never joined.
/// Errors: corrupt (no segment), unsupported (an index file), too_few_samples (no channel of
/// figures).
/// Cost: one pass over the lead-ins and metadata; 40 bytes of memory for each segment that is not
/// like the one before it.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_tdms(std::unique_ptr<PeekSource> source,
                                                           const ReadOptions& options);

}  // namespace proofmass::io
