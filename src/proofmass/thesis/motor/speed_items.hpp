#pragma once

#include "proofmass/thesis/item.hpp"
#include "proofmass/thesis/wheel/study.hpp"

// The error against the speed.
namespace proofmass::thesis {

/// Figure 5.17.
[[nodiscard]] Item speed_item(const WheelStudy& study);

}  // namespace proofmass::thesis
