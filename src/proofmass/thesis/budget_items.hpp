#pragma once

#include <vector>

#include "proofmass/thesis/item.hpp"

// Section 2.4.1: the position error caused by a bias.
namespace proofmass::thesis {

/// Table 2.1.
[[nodiscard]] std::vector<Item> budget_items();

}  // namespace proofmass::thesis
