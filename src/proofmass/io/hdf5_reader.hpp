#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io {

/// Whether a file is HDF5, with or without a block of its user before it, by its first bytes;
/// MATLAB's version 7.3 is.
[[nodiscard]] bool claims_hdf5(std::string_view head, std::string_view file_name);

/// Opens HDF5: the datasets of one length that lie together (choose_datasets()) are the channels;
/// names, attributes and texts say what they are (hdf5_labels.hpp). MATLAB's version 7.3 is read as
/// the older ones are. ReadOptions::variables are settled here: the file has one table, made of
/// what they name, or of what is chosen. The library that unpacks the file runs in a process of its
/// own with limits of memory and time, which hands on a block of rows at a time and ends with the
/// reader, or with the thread that opened it: a file that brings it down is refused as any other.
/// Errors: corrupt, unsupported (built without the library; more figures than the file has room
/// for), too_few_samples, invalid_argument, unreadable.
/// Cost: some MiB; what is compressed or comes from no file is held in memory besides.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open_hdf5(std::unique_ptr<PeekSource> source,
                                                           const ReadOptions& options);

}  // namespace proofmass::io
