#pragma once

#include <memory>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/output_file.hpp"
#include "proofmass/io/recording_writer.hpp"

namespace proofmass::io {

// The writers of write_recording(), one per format; see there for the contents of each.

[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> csv_writer(std::unique_ptr<OutputFile> file,
                                                                  const WriterHead& head,
                                                                  const WriteOptions& options);
[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> npy_writer(std::unique_ptr<OutputFile> file,
                                                                  const WriterHead& head,
                                                                  const WriteOptions& options);
/// A group "recording" with one chunked dataset of doubles per channel. Errors: unsupported (built
/// without the library).
[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> hdf5_writer(std::unique_ptr<OutputFile> file,
                                                                   const WriterHead& head,
                                                                   const WriteOptions& options);
/// One column of doubles per channel, by DuckDB's library, which is loaded when this is called.
/// Errors: unsupported (no such library).
[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> parquet_writer(
    std::unique_ptr<OutputFile> file, const WriterHead& head, const WriteOptions& options);

[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> mat_writer(std::unique_ptr<OutputFile> file,
                                                                  const WriterHead& head,
                                                                  const WriteOptions& options);

[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> tdms_writer(std::unique_ptr<OutputFile> file,
                                                                   const WriterHead& head,
                                                                   const WriteOptions& options);

[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> mcap_writer(std::unique_ptr<OutputFile> file,
                                                                   const WriterHead& head,
                                                                   const WriteOptions& options);

}  // namespace proofmass::io
