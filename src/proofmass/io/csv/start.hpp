#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/csv/layout.hpp"

namespace proofmass::io {

/// Time of zero of a table's stamps, which count seconds from its start, given in a line before the
/// rows.
struct CsvStart {
  std::optional<std::int64_t> zero_ns;  ///< since 1970, assuming that the clock is UTC
  std::vector<Note> notes;
};

/// Source: Gulf Coast Data Concepts, X16-1D User Manual B, "Data File Header Tags" (";Start_time,
/// 2018-02-09, 08:21:42.830", gain and dead band besides); Vieyra Software, Physics Toolbox Sensor
/// Suite ("# Recording started at: 2026-09-23 16:53:10.681").
[[nodiscard]] CsvStart read_csv_start(const CsvLayout& layout);

}  // namespace proofmass::io
