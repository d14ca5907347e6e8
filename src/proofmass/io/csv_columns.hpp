#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/csv_header.hpp"
#include "proofmass/io/csv_layout.hpp"
#include "proofmass/io/csv_rows.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Which columns of a table are read as what.
struct CsvColumns {
  std::vector<ColumnUse> uses;
  std::optional<std::size_t> stamps;  ///< the time column
  std::optional<std::size_t> date;    ///< the column before it that holds the date
  std::optional<std::size_t> labels;  ///< the column of words that became the labels
  StampSpelling spelling = StampSpelling::figures;
};

/// Chooses the time column: the one --time names, else by name or unit, else a calendar's, else an
/// ascending first column without a name. The first few columns of words may be labels.
/// Errors: invalid_argument (there is no column called as --time says, or it holds words).
[[nodiscard]] Result<CsvColumns> choose_columns(const CsvLayout& layout,
                                                const CsvHeader& header,
                                                const ReadOptions& options);

}  // namespace proofmass::io
