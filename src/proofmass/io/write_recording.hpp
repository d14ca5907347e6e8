#pragma once

#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

namespace proofmass::io {

/// Writes a recording in the format that the file's extension names:
///  - .csv, .csv.gz ("-": CSV to standard output): a header "time (s),name (unit),…", then one row
///    a sample, every figure in the shortest form that reads back bit for bit; NaN as "nan". Times
///    are on the recording's own clock where it has one (TimeBase::start_ns), else from 0. There is
///    no time column where the recording has no time base.
///  - .npy: little-endian float64, C order, samples × (1 + channels): column 0 is the time in
///    seconds since the first sample (absent where the recording has no time base), the others the
///    channels in their order and unit. Names and units are not kept by this format.
/// The file appears under its name only when it is complete.
/// Errors: unsupported (another extension: names those there are), unreadable (cannot be written),
/// too_few_samples (no channels).
[[nodiscard]] Status write_recording(const Recording& recording, const std::string& path);

}  // namespace proofmass::io
