#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// The last steps of every reading: puts the rows into the reader's recording, finds the time base,
/// settles units, keeps the channels asked for. All rows must have been read.
/// Errors: too_few_samples (no channel of numbers), invalid_argument (no channel of a name asked
/// for; a rate not above zero).
[[nodiscard]] Result<Recording> finish_recording(RecordingReader& reader,
                                                 RawRows rows,
                                                 const ReadOptions& options);

/// Reads all rows, and the same. Errors: also those of the reader.
[[nodiscard]] Result<Recording> read_whole(RecordingReader& reader, const ReadOptions& options);

/// Corrects the multiplexer skew of the options, then keeps the channels asked for.
/// Errors: invalid_argument (no channel of a name asked for), those of signal::without_skew.
[[nodiscard]] Result<Recording> apply_channel_options(Recording recording,
                                                      const ReadOptions& options);

/// Errors: invalid_argument (a rate not above zero).
[[nodiscard]] Status check_rate(const ReadOptions& options);

/// The channels asked for, as places in the recording's, in its order; empty names: all.
/// Errors: invalid_argument (no channel of such a name).
[[nodiscard]] Result<std::vector<std::size_t>> chosen_channels(
    const Recording& recording, const std::vector<std::string>& names);

}  // namespace proofmass::io
