#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// The recordings in a folder or a zip archive, each a table called by its file less the endings
/// (a file of several tables: "file/table"). What the export of a phone or a logger says beside
/// them (archive_layout.hpp) goes into the tables; files that are no recording are told, and
/// archives within are not opened. Where all files are NumPy arrays, it is open_npz()'s. Errors:
/// too_few_samples (no recording in it), unsupported (an office document), or what is wrong with
/// the only file.
/// Cost: opens every file of at most 512 for its headings; where several hold accelerations those
/// that are text are read once for the number of their rows.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_tables_in(std::unique_ptr<Archive> archive,
                                                                const ReadOptions& options);

}  // namespace proofmass::io
