#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "proofmass/thesis/item.hpp"

// How far what the thesis prints and what we find go together.
namespace proofmass::thesis {

/// Numbers agree within this part of what the thesis prints, or within so many standard deviations.
inline constexpr double alike = 0.1, alike_std = 2.0;

/// Of the numbers that the thesis prints.
struct Agreement {
  std::size_t printed = 0;   ///< all of them
  std::size_t compared = 0;  ///< those that we could find too
  std::size_t agreeing = 0;  ///< of these, in agreement
};

[[nodiscard]] bool is_compared(const Finding& finding);

/// Of a number that is compared.
[[nodiscard]] bool agrees(const Finding& finding);

[[nodiscard]] Agreement agreement(const Item& item);
[[nodiscard]] Agreement agreement(const std::vector<Item>& items);

/// "3 of 4 agree", "not determined"; empty where nothing is printed.
[[nodiscard]] std::string agreement_words(const Agreement& agreement);

/// The figures as people read them, in the unit that is shown; empty where there is none.
[[nodiscard]] std::string thesis_words(const Finding& finding);
[[nodiscard]] std::string ours_words(const Finding& finding);

/// Ours against what is printed, with the standard deviations where they alone make it agree:
/// "+3.1 %", "+88 %, 0.7 std", "× 36", "1/36", "other sign"; empty where one is absent.
[[nodiscard]] std::string against_words(const Finding& finding);

}  // namespace proofmass::thesis
