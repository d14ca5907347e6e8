#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/acquire/framing/plan.hpp"

namespace proofmass::acquire {

struct FoundClock {
  std::size_t field = 0;
  RowPlan::Clock clock{};
};

/// The device's clock: the field given by time=; else a field with such a name that does not
/// decrease; else, for rows without names, a first field that increases at a rate consistent with
/// s, ms, us or ns. Its unit: from time-unit=, the heading, the name, the rate at which rows
/// arrived, and if they arrived all at once, the rule for files (io/stamp_unit.hpp).
/// Errors: invalid_argument (no such column; unknown unit).
[[nodiscard]] Result<std::optional<FoundClock>> find_clock(const RowEvidence& rows,
                                                           const FramingOptions& options,
                                                           std::vector<Note>& notes);

}  // namespace proofmass::acquire
