#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// The recordings in a folder or a zip archive, each a table named by its file without extensions
/// (for a file of several tables: "file/table"). Metadata in a phone's or logger's export
/// (layouts/layout.hpp) are applied to the tables. Files that are not recordings are reported, and
/// nested archives are not opened. If all files are NumPy arrays, the result is that of open_npz().
/// Errors: too_few_samples (no recording in it), unsupported (an office document), or the error of
/// the only file.
/// Cost: opens at most 512 files for their headings; if several contain accelerations, the text
/// files are read once to count their rows.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_tables_in(std::unique_ptr<Archive> archive,
                                                                const ReadOptions& options);

}  // namespace proofmass::io
