#pragma once

#include <vector>

#include "proofmass/thesis/item.hpp"

// Appendix A.2: the motor and the wheel.
namespace proofmass::thesis {

/// Section A.2: speed, path, torque and power.
[[nodiscard]] std::vector<Item> motor_items();

}  // namespace proofmass::thesis
