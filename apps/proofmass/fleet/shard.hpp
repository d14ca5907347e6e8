#pragma once

#include <string>

#include "proofmass/fleet/results.hpp"

namespace proofmass::app {

/// "2/4", or "4" with the number from the variables that array jobs have; empty: both from them, or
/// all recordings where there are none. Throws Failure (usage).
[[nodiscard]] fleet::Shard parse_shard(const std::string& text);

}  // namespace proofmass::app
