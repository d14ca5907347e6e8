#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "proofmass/acquire/framing_plan.hpp"

namespace proofmass::acquire {

struct FoundClock {
  std::size_t field = 0;
  RowPlan::Clock clock{};
};

/// The device's clock: the field that time= names; else one that is called so and does not fall;
/// else, of rows without names, a first field that ascends at a pace that s, ms, us or ns explain.
/// Its unit: by time-unit=, the heading, the name, the pace at which rows came, and where they
/// came all at once the rule for files (io/stamp_unit.hpp).
/// Errors: invalid_argument (no such column; nobody says its unit).
[[nodiscard]] Result<std::optional<FoundClock>> find_clock(const RowEvidence& rows,
                                                           const FramingOptions& options,
                                                           std::vector<Note>& notes);

}  // namespace proofmass::acquire
