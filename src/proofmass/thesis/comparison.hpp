#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/thesis/item.hpp"

// Agreement of the thesis's printed values with ours.
namespace proofmass::thesis {

/// Tolerances of agreement: relative to the printed value, or in standard deviations.
inline constexpr double alike = 0.1, alike_std = 2.0;

/// Counts of the numbers printed in the thesis.
struct Agreement {
  std::size_t printed = 0;   ///< all of them
  std::size_t compared = 0;  ///< those that we could determine too
  std::size_t agreeing = 0;  ///< of these, in agreement
};

[[nodiscard]] bool is_compared(const Finding& finding);

/// Whether a compared number agrees.
[[nodiscard]] bool agrees(const Finding& finding);

[[nodiscard]] Agreement agreement(const Item& item);
[[nodiscard]] Agreement agreement(const std::vector<Item>& items);

/// "3 of 4 agree", "not determined"; empty if nothing is printed.
[[nodiscard]] std::string agreement_words(const Agreement& agreement);

/// The values for display, in the display unit; empty if there is none.
[[nodiscard]] std::string thesis_words(const Finding& finding);
[[nodiscard]] std::string ours_words(const Finding& finding);

/// Ours against the printed value, with the standard deviations if only they make it agree: "+3.1
/// %", "+88 %, 0.7 std", "× 36", "1/36", "other sign"; empty if one is absent.
[[nodiscard]] std::string against_words(const Finding& finding);

}  // namespace proofmass::thesis
