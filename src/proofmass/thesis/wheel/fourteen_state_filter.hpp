#pragma once

#include <optional>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"
#include "proofmass/thesis/wheel/run_errors.hpp"

// Appendix A.1: both axes of both sensors in one filter of fourteen states.
namespace proofmass::thesis {

/// Its results as a path.
struct FourteenStateFilter {
  PathError roll_filtered, roll_smoothed;  ///< mean of the positions of y1 and y2
  PathError all_filtered, all_smoothed;    ///< mean of all four
};

/// The thesis's filter corrected (a row of H for each axis, the warm-up as known input), W = 1 for
/// each axis, the second sensor rotated by 180° so that gravity cancels in the means. nullopt
/// without a pair or a radius. Errors: of the filter, with the recording's name.
[[nodiscard]] Result<std::optional<FourteenStateFilter>> fourteen_state_filter(
    const FirstTurn& turn);

}  // namespace proofmass::thesis
