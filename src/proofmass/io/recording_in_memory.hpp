#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Sample times of arrays: stamps, or none and the rate of ReadOptions.
struct ArrayTimes {
  std::vector<double> stamps_s{};  ///< from the first sample
  std::optional<std::int64_t> start_ns{};
  std::string column{};  ///< name of the stamp column
};

/// A recording from arrays, with time base and units determined as for a file; empty units are
/// unknown.
/// Errors: invalid_argument (columns of unequal length; stamps of another; a rate not above zero),
/// too_few_samples (no sample).
[[nodiscard]] Result<Recording> recording_of_arrays(std::vector<Channel> channels,
                                                    ArrayTimes times,
                                                    const ReadOptions& options);

/// Applies the options of read_recording() to a recording in memory: the rate replaces its time
/// base; accelerometer unit, skew, channel selection and even grid are applied as for a file.
/// Errors: invalid_argument (a channel that does not exist; a rate not above zero; a time column or
/// a variable, which only files have), and those of resampling.
[[nodiscard]] Result<Recording> recording_in_memory(Recording recording,
                                                    const ReadOptions& options);

}  // namespace proofmass::io
