#pragma once

#include <memory>

#include "proofmass/io/archive_layout.hpp"
#include "proofmass/io/csv_header.hpp"
#include "proofmass/io/recording_reader.hpp"

namespace proofmass::io {

/// A column's name and unit with what the archive says of it: one called by an axis alone gets the
/// sensor's name and unit.
[[nodiscard]] ColumnLabel with_hint(ColumnLabel label, const MemberHint& hint);

/// The same recording with what its archive says of it: names and units of columns; stamps get the
/// wall clock's origin; a table without a time its rate.
[[nodiscard]] std::unique_ptr<RecordingReader> with_hint(std::unique_ptr<RecordingReader> reader,
                                                         const MemberHint& hint);

}  // namespace proofmass::io
