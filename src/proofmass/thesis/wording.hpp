#pragma once

#include <string>
#include <vector>

#include "proofmass/thesis/documents.hpp"

// What page and text say alike.
namespace proofmass::thesis {

/// How many tables and figures, and how far their numbers go together, in a sentence or two.
[[nodiscard]] std::string thesis_conclusion(const std::vector<Item>& items);

/// One number of ours that says what the programme comes to.
struct Headline {
  std::string label, value;
};

/// What the thesis's way and the wheel's own model make of the same turn, as far as it is known.
[[nodiscard]] std::vector<Headline> headlines(const std::vector<Item>& items);

/// "Table 2.1. Position error …".
[[nodiscard]] std::string heading(const Item& item);

/// What was not recorded and hence simulated, in a sentence; empty where nothing was.
[[nodiscard]] std::string simulated_words(const ThesisReport& report);

}  // namespace proofmass::thesis
