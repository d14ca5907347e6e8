#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// Names of the columns of a numeric table, and which of them is the time.
struct NamedColumns {
  std::vector<ColumnLabel> labels;  ///< one per column, unique names
  std::optional<std::size_t> time;
  bool are_made_up = false;  ///< the names are generated
  std::vector<Note> notes;
};

/// Names the columns by their headings without units; `headings` empty: as for a CSV without a
/// header. The time is the column given by --time, else the one with a name or unit of time, else
/// an increasing first column without a name.
/// Errors: invalid_argument (no column with the name given by --time).
[[nodiscard]] Result<NamedColumns> name_columns(const std::vector<std::string>& headings,
                                                std::size_t columns,
                                                bool first_ascends,
                                                const ReadOptions& options);

/// True if an unnamed column may be the time: finite and strictly increasing.
[[nodiscard]] bool ascends(View<double> values);

/// The heading of the time as in name_columns(); nullopt if there is none.
[[nodiscard]] std::optional<std::size_t> time_among(const std::vector<std::string>& headings,
                                                    const ReadOptions& options);

/// The first finite stamp of plausible magnitude, exact to a nanosecond, or to one for large
/// values; nullopt if there is none.
[[nodiscard]] std::optional<StampOrigin> origin_of(View<double> stamps);

}  // namespace proofmass::io
