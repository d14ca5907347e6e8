#pragma once

#include <memory>

#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// Apps that log several sensors into one table give each reading a row of its own, with blanks in
/// the columns of the others. Of such a table, which its first rows give away, the rows and columns
/// of one sensor: of the channels asked for, else of the accelerometer; what is left out is told. A
/// reading whose axes fell on two stamps (less than a quarter of a step apart) is put together
/// again, on the first. Any other table comes out as it is.
[[nodiscard]] std::unique_ptr<RecordingReader> rows_of_one_sensor(
    std::unique_ptr<RecordingReader> reader, const RawRows& first, const ReadOptions& options);

}  // namespace proofmass::io
