#pragma once

#include <memory>

#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/layouts/layout.hpp"
#include "proofmass/io/reading/recording_reader.hpp"

namespace proofmass::io {

/// A column's name and unit with the hints of the archive: one named by an axis alone gets the
/// sensor's name and unit.
[[nodiscard]] ColumnLabel with_hint(ColumnLabel label, const MemberHint& hint);

/// The same recording with the hints of its archive: names and units of columns; the origin of
/// stamps on the wall clock; the rate of a table without time.
[[nodiscard]] std::unique_ptr<RecordingReader> with_hint(std::unique_ptr<RecordingReader> reader,
                                                         const MemberHint& hint);

}  // namespace proofmass::io
