#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::lvm {

/// True if the first line is that of a LabVIEW measurement file.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens a LabVIEW measurement file. Segments of the same channels are one table, each row at its
/// own segment's start + X0 + k · Delta_X, or at its X value; channels with another Delta_X, and
/// segments with other channels, are separate tables. Comments and special blocks are reported in
/// notes. Dates and times of day are assumed to be UTC.
/// Source: National Instruments, "Specification for the LabVIEW Measurement File (.lvm)" (2010).
/// Errors: corrupt (no segment of numbers), unreadable.
/// Cost: the file is read twice, once for its segments; memory grows with their number.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::lvm
