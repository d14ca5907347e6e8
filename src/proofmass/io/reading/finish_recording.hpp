#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// The last steps of every reader: puts the rows into the reader's recording, determines the time
/// base and the units, selects the requested channels. All rows must have been read.
/// Errors: too_few_samples (no numeric channel), invalid_argument (no channel of a requested name;
/// a rate not above zero).
[[nodiscard]] Result<Recording> finish_recording(RecordingReader& reader,
                                                 RawRows rows,
                                                 const ReadOptions& options);

/// Reads all rows, then the same. Errors: also those of the reader.
[[nodiscard]] Result<Recording> read_whole(RecordingReader& reader, const ReadOptions& options);

/// Corrects the multiplexer skew of the options, then selects the requested channels.
/// Errors: invalid_argument (no channel of a requested name), those of signal::without_skew.
[[nodiscard]] Result<Recording> apply_channel_options(Recording recording,
                                                      const ReadOptions& options);

/// Errors: invalid_argument (a rate not above zero).
[[nodiscard]] Status check_rate(const ReadOptions& options);

/// Indices of the requested channels in the recording, in its order; empty names: all.
/// Errors: invalid_argument (no channel of such a name).
[[nodiscard]] Result<std::vector<std::size_t>> chosen_channels(
    const Recording& recording, const std::vector<std::string>& names);

}  // namespace proofmass::io
