#pragma once

#include <memory>
#include <string>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/recording_writer.hpp"

namespace proofmass::io {

/// Writes a recording in the format that the file's extension names:
///  - .csv, .csv.gz ("-": CSV to standard output): a header "time (s),name (unit),…", then one row
///    a sample, every figure in the shortest form that reads back bit for bit; NaN as "nan". Times
///    are on the recording's own clock where it has one (TimeBase::start_ns), else from 0. There is
///    no time column where the recording has no time base.
///  - .npy: little-endian float64, C order, samples × (1 + channels): column 0 is the time in
///    seconds since the first sample (absent where the recording has no time base), the others the
///    channels in their order and unit. Names and units are not kept by this format.
///  - .mat: version 5, a vector of doubles a channel, with their names and units beside.
///  - .tdms: version 2, interleaved, in segments that are each complete.
///  - .h5, .hdf5: a dataset of doubles a channel, in chunks.
///  - .mcap: blocks of samples as messages, chunks with checksums, an index.
///  - .parquet: a column of doubles a channel, by DuckDB's library where it is there.
/// docs/formats.md has the layout of each. The file appears under its name only when it is
/// complete.
/// Errors: unsupported (another extension: names those there are; a library that is not there),
/// unwritable (cannot be written), too_few_samples (no channels).
[[nodiscard]] Status write_recording(const Recording& recording,
                                     const std::string& path,
                                     const WriteOptions& options = {});

/// The same for a recording that comes a piece at a time.
[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> open_writer(const std::string& path,
                                                                   const WriterHead& head,
                                                                   const WriteOptions& options);

/// Whether a recording's labels go into a file of that name: most formats have room for them,
/// some only where they are known before the first sample, as of a whole recording.
[[nodiscard]] bool keeps_labels(const std::string& path, bool in_pieces);

/// All samples of a recording as one piece, which holds as long as the recording.
[[nodiscard]] Block whole_of(const Recording& recording);

}  // namespace proofmass::io
