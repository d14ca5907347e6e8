#pragma once

#include <memory>
#include <string_view>

#include "proofmass/io/bytes/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/table_file.hpp"

namespace proofmass::io::hdf5 {

/// True if a file is HDF5, with or without a user block, by its first bytes; MATLAB's version 7.3
/// is.
[[nodiscard]] bool claims(std::string_view head, std::string_view file_name);

/// Opens HDF5.
///
/// - The channels are the datasets of one length that belong together (choose_datasets()); names,
///   attributes and texts describe them (hdf5/labels.hpp). MATLAB's version 7.3 is read like the
///   older ones.
/// - ReadOptions::variables are handled here: the file has one table, of the named datasets or of
///   the selected ones.
/// - The library runs in a child process with limits on memory and time, which transfers one block
///   of rows at a time and ends with the reader, or with the thread that opened it: a file that
///   crashes it is rejected like any other.
///
/// Errors: corrupt, unsupported (built without the library; more values than the file can hold),
/// too_few_samples, invalid_argument, unreadable.
/// Cost: some MiB; compressed data, or data that are not in a file, are held in memory in addition.
[[nodiscard]] Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                                      const ReadOptions& options);

}  // namespace proofmass::io::hdf5
