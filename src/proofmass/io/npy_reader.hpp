#pragma once

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Reads a NumPy array: 1-D is one channel; 2-D is samples × channels, or channels × samples where
/// there are far more columns than rows; a structured array's fields are the channels. Column 0 of
/// a plain 2-D array is the time in seconds if it ascends.
[[nodiscard]] Result<Recording> read_npy(PeekSource& source, const ReadOptions& options);

}  // namespace proofmass::io
