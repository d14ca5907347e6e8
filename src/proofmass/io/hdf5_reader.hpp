#pragma once

#include <string_view>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Whether a file is HDF5, with or without a block of its user before it, by its first bytes;
/// MATLAB's version 7.3 is.
[[nodiscard]] bool claims_hdf5(std::string_view head, std::string_view file_name);

/// Reads HDF5: the datasets of one length that lie together (choose_datasets()) are the channels;
/// names, attributes and texts say what they are (hdf5_labels.hpp). MATLAB's version 7.3 is read as
/// read_mat() reads the older ones. The library that unpacks the file runs in a process of its own
/// with limits of memory and time: a file that brings it down is refused as any other.
/// Errors: corrupt, unsupported (built without the library; more figures than the file has room
/// for), too_few_samples, invalid_argument, unreadable.
/// Cost: the columns; what is compressed or comes from no file is held in memory besides.
[[nodiscard]] Result<Recording> read_hdf5_file(PeekSource& source, const ReadOptions& options);

}  // namespace proofmass::io
