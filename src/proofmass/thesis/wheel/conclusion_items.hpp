#pragma once

#include <vector>

#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// The thesis's conclusions on the wheel, and its speeds.
namespace proofmass::thesis {

/// Section 6.1 and table A.1.
[[nodiscard]] std::vector<Item> conclusion_items(const WheelStudy& study);

}  // namespace proofmass::thesis
