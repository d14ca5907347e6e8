#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/output_file.hpp"
#include "proofmass/io/recording_writer.hpp"

namespace proofmass::io {

/// Begins a file of one format; see write_recording() for the contents of each.
using CreateWriter = Result<std::unique_ptr<RecordingWriter>>(std::unique_ptr<OutputFile> file,
                                                              const WriterHead& head,
                                                              const WriteOptions& options);

CreateWriter create_csv, create_npy;

namespace hdf5 {
/// A group "recording" with one chunked dataset of doubles per channel. Errors: unsupported (built
/// without the library).
CreateWriter create;
}  // namespace hdf5

namespace matlab {
CreateWriter create;
}  // namespace matlab

namespace mcap {
CreateWriter create;
}  // namespace mcap

namespace parquet {
/// One column of doubles per channel, by DuckDB's library, which is loaded when this is called.
/// Errors: unsupported (no such library).
CreateWriter create;
}  // namespace parquet

namespace tdms {
CreateWriter create;
}  // namespace tdms

}  // namespace proofmass::io
