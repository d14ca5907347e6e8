#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/csv_header.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// What the columns of a table of figures are called, and which of them is the time.
struct NamedColumns {
  std::vector<ColumnLabel> labels;  ///< one a column, names unique
  std::optional<std::size_t> time;
  bool are_made_up = false;  ///< the names are no one's but ours
  std::vector<Note> notes;
};

/// Names the columns by their headings, units taken off; `headings` empty: as those of a CSV
/// without a header. The time is the column that --time names, else the one with such a name or
/// unit, else an ascending first column without a name.
/// Errors: invalid_argument (no column called as --time says).
[[nodiscard]] Result<NamedColumns> name_columns(const std::vector<std::string>& headings,
                                                std::size_t columns,
                                                bool first_ascends,
                                                const ReadOptions& options);

/// Whether a column without a name may be the time: finite, and each value above the one before.
[[nodiscard]] bool ascends(View<double> values);

/// The heading that is the time's, as name_columns() takes it; nullopt if none is.
[[nodiscard]] std::optional<std::size_t> time_among(const std::vector<std::string>& headings,
                                                    const ReadOptions& options);

/// The first stamp that is a number of sane size, exact to a nanosecond or, of large figures, to
/// one; nullopt if there is none.
[[nodiscard]] std::optional<StampOrigin> origin_of(View<double> stamps);

}  // namespace proofmass::io
