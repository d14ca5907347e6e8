#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::io {

/// What a format of binary arrays has read: equally long columns, and what they are called.
struct ArrayColumns {
  std::vector<std::vector<double>> values;
  std::vector<std::string> headings;  ///< one a column, units included; empty: none has a name
  std::optional<double> rate_hz;      ///< if the file says
};

/// Whether a column without a name may be the time: finite, and each value above the one before.
[[nodiscard]] bool ascends(View<double> values);

/// The heading that is the time's, as recording_of() takes it; nullopt if none is.
[[nodiscard]] std::optional<std::size_t> time_among(const std::vector<std::string>& headings,
                                                    const ReadOptions& options);

/// Makes channels of columns: the time is the one that --time names, else by name or unit; columns
/// without names are called as those of a CSV without a header, the first being the time in seconds
/// if it ascends. `recording` has its format and notes so far.
/// Errors: as finish_recording(), and invalid_argument (no column called as --time says).
[[nodiscard]] Result<Recording> recording_of(ArrayColumns columns,
                                             Recording recording,
                                             const ReadOptions& options);

}  // namespace proofmass::io
