#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/csv/rows.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// Role of each column of a table.
struct CsvColumns {
  std::vector<ColumnUse> uses;
  std::optional<std::size_t> stamps;  ///< the time column
  std::optional<std::size_t> date;    ///< the preceding column with the date
  std::optional<std::size_t> labels;  ///< the text column used as labels
  StampSpelling spelling = StampSpelling::figures;
};

/// Selects the time column: the one given by --time, else by name or unit, else a calendar column,
/// else an increasing first column without a name. The first few text columns may be labels.
/// Errors: invalid_argument (no column with the name given by --time, or it contains text).
[[nodiscard]] Result<CsvColumns> choose_columns(const CsvLayout& layout,
                                                const CsvHeader& header,
                                                const ReadOptions& options);

}  // namespace proofmass::io
