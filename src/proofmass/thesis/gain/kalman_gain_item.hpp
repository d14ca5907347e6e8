#pragma once

#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/thesis_paths.hpp"
#include "proofmass/thesis/wheel/first_turn.hpp"

// Section 5.4: the gain of the filter of the paths.
namespace proofmass::thesis {

/// Figure 5.16. Expects paths = thesis_paths(reading).
[[nodiscard]] Item kalman_gain_item(const FirstTurn& turn,
                                    const FusedReading& reading,
                                    const ThesisPaths& paths);

}  // namespace proofmass::thesis
