#pragma once

#include <cstdint>
#include <vector>

#include "proofmass/thesis/item.hpp"

// Sections 4.1.4, 5.2 and 5.3: the effect of Q and R.
namespace proofmass::thesis {

/// Figures 4.3 and 5.7 to 5.10. The seed is that of the simulated measurements.
[[nodiscard]] std::vector<Item> gain_items(std::uint64_t seed);

}  // namespace proofmass::thesis
