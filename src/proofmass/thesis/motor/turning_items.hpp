#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// Sections 5.5 and 5.6: angular acceleration and angle.
namespace proofmass::thesis {

/// Figures 5.18 and 5.19. Errors: those of the angular model's filter.
[[nodiscard]] Result<std::vector<Item>> turning_items(const WheelStudy& study);

}  // namespace proofmass::thesis
