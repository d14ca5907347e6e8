#pragma once

#include <memory>
#include <string>

#include "proofmass/core/block.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/recording_writer.hpp"

namespace proofmass::io {

/// Writes a recording in the format given by the file's extension:
///
/// - .csv, .csv.gz ("-": CSV to standard output): a header "time (s),name (unit),…", then one row
///   per sample, every number in the shortest form that reads back bit for bit; NaN as "nan". Times
///   are on the recording's own clock if it has one (TimeBase::start_ns), else from 0. There is no
///   time column if the recording has no time base.
/// - .npy: little-endian float64, C order, samples × (1 + channels): column 0 is the time in
///   seconds from the first sample (absent if the recording has no time base), the others are the
///   channels in their order and unit. This format keeps no names and units.
/// - .mat: version 5, one vector of doubles per channel, with their names and units.
/// - .tdms: version 2, interleaved, in self-contained segments.
/// - .h5, .hdf5: one chunked dataset of doubles per channel.
/// - .mcap: blocks of samples as messages, chunks with checksums, an index.
/// - .parquet: one column of doubles per channel, by DuckDB's library if it is available.
///
/// See docs/formats.md for the layout of each. The file appears under its name only when it is
/// complete.
/// Errors: unsupported (another extension: lists the known ones; a missing library), unwritable
/// (cannot be written), too_few_samples (no channels).
[[nodiscard]] Status write_recording(const Recording& recording,
                                     const std::string& path,
                                     const WriteOptions& options = {});

/// The same for a recording in blocks.
[[nodiscard]] Result<std::unique_ptr<RecordingWriter>> open_writer(const std::string& path,
                                                                   const WriterHead& head,
                                                                   const WriteOptions& options);

/// True if a recording's labels are stored in a file of that name: most formats support them, some
/// only if they are known before the first sample, as for a whole recording.
[[nodiscard]] bool keeps_labels(const std::string& path, bool in_pieces);

/// All samples of a recording as one block, valid as long as the recording.
[[nodiscard]] Block whole_of(const Recording& recording);

}  // namespace proofmass::io
