#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/csv/columns.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/csv/rows.hpp"

namespace proofmass::io {

/// Notes on the detected dialect and the interpretation of the columns.
void note_layout(const CsvLayout& layout,
                 const CsvHeader& header,
                 const CsvColumns& columns,
                 std::vector<Note>& notes);

/// Notes on faults of the rows, each with its count and first line; `point` is the decimal mark.
void note_faults(const RowFaults& faults,
                 const CsvHeader& header,
                 const CsvColumns& columns,
                 char point,
                 std::vector<Note>& notes);

}  // namespace proofmass::io
