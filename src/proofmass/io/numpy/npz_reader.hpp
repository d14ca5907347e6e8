#pragma once

#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// True if the first bytes are those of a zip archive whose first file is a NumPy array, or of any
/// zip archive named .npz.
[[nodiscard]] bool claims_npz(std::string_view head, std::string_view file_name);

/// True if a file of an archive is a NumPy array.
[[nodiscard]] bool holds_npy(const Archive& archive);

/// Opens an archive of NumPy arrays, which are selected like the variables of a MAT file: the
/// largest table with the vectors of its length beside it, or those named by
/// ReadOptions::variables; a scalar named "fs" is the rate. The fields of a structured array are
/// "name.field". Errors: corrupt, unreadable, unsupported, too_few_samples (no table),
/// invalid_argument.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_npz(std::unique_ptr<Archive> archive,
                                                          const ReadOptions& options);

/// The same from the bytes of the zip archive.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_npz(std::unique_ptr<PeekSource> source,
                                                          const ReadOptions& options);

}  // namespace proofmass::io
