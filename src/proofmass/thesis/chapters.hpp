#pragma once

#include <string>
#include <vector>

#include "proofmass/thesis/item.hpp"

// The thesis's chapters, by which its tables and figures are grouped.
namespace proofmass::thesis {

struct Chapter {
  std::string key;                 ///< "2" … "6", "A"
  std::string title;               ///< "Chapter 2. Robot Localization"
  std::vector<const Item*> items;  ///< in their order
};

/// The number before the point of the id: "2" of "table 2.1".
[[nodiscard]] std::string chapter_key(const Item& item);

/// Chapters that have items, in the order of the first of each. The items must outlive the result.
[[nodiscard]] std::vector<Chapter> chapters(const std::vector<Item>& items);

}  // namespace proofmass::thesis
