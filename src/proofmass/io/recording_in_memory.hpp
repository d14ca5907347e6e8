#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// When the samples of arrays were taken: stamps, or none and the rate of ReadOptions.
struct ArrayTimes {
  std::vector<double> stamps_s{};  ///< since the first sample
  std::optional<std::int64_t> start_ns{};
  std::string column{};  ///< that the stamps were in
};

/// A recording of arrays, with time base and units found as of a file's; empty units are unknown.
/// Errors: invalid_argument (columns of unequal length; stamps of another; a rate not above zero),
/// too_few_samples (no sample).
[[nodiscard]] Result<Recording> recording_of_arrays(std::vector<Channel> channels,
                                                    ArrayTimes times,
                                                    const ReadOptions& options);

/// What read_recording() makes of a file, of a recording that is in memory: the rate in place of
/// its time base, the unit of its accelerometers, the skew undone, the channels asked for, the even
/// grid.
/// Errors: invalid_argument (a channel that is not there; a rate not above zero; a time column or a
/// variable, which only files have), and those of resampling.
[[nodiscard]] Result<Recording> recording_in_memory(Recording recording,
                                                    const ReadOptions& options);

}  // namespace proofmass::io
