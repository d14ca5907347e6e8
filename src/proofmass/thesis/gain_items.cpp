#include "proofmass/thesis/gain_items.hpp"

#include <array>

#include "proofmass/thesis/gain/figures.hpp"
#include "proofmass/thesis/gain/parts.hpp"

namespace proofmass::thesis {

std::vector<Item> gain_items(std::uint64_t seed) {
  const std::array<Half, 2> halves{{{.options = quick_filter,
                                     .readings_id = "figure 5.7",
                                     .gain_id = "figure 5.8",
                                     .relation = "Q > R",
                                     .printed_settling_s = 2.0},
                                    {.options = slow_filter,
                                     .readings_id = "figure 5.9",
                                     .gain_id = "figure 5.10",
                                     .relation = "Q < R",
                                     .printed_settling_s = 8.0}}};
  std::vector<Item> items{covariance_item()};
  for (const Half& half : halves) {
    items.push_back(readings_item(half, seed));
    items.push_back(settling_item(half));
  }
  return items;
}

}  // namespace proofmass::thesis
