#pragma once

#include <memory>

#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// Apps that log several sensors into one table give each measurement its own row, with blanks in
/// the columns of the others. From such a table, recognised by its first rows, selects the rows and
/// columns of one sensor: that of the requested channels, else the accelerometer; omitted data are
/// reported. A measurement whose axes have two stamps (less than a quarter of a period apart) is
/// merged, at the first stamp. Any other table is passed through unchanged.
[[nodiscard]] std::unique_ptr<RecordingReader> rows_of_one_sensor(
    std::unique_ptr<RecordingReader> reader, const RawRows& first, const ReadOptions& options);

}  // namespace proofmass::io
