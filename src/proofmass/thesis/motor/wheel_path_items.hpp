#pragma once

#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// Section 5.4: acceleration, position and gain through one revolution.
namespace proofmass::thesis {

/// Figures 5.12 to 5.16. Errors: those of thesis_paths().
[[nodiscard]] Result<std::vector<Item>> wheel_path_items(const WheelStudy& study);

}  // namespace proofmass::thesis
