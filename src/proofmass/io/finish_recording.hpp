#pragma once

#include <optional>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/time_base.hpp"

namespace proofmass::io {

/// The last steps of every reader: finds the time base, settles units, keeps the channels asked
/// for. `recording` has its channels, first_line and notes so far.
/// Errors: too_few_samples (no channel of numbers), invalid_argument (no channel of a name asked
/// for; a rate not above zero).
[[nodiscard]] Result<Recording> finish_recording(Recording recording,
                                                 std::optional<StampColumn> stamps,
                                                 std::optional<double> header_rate_hz,
                                                 const ReadOptions& options);

}  // namespace proofmass::io
