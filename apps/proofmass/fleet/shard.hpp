#pragma once

#include <string>

#include "proofmass/fleet/results.hpp"

namespace proofmass::app {

/// "2/4", or "4" with the index from the environment of an array job; empty: both from the
/// environment, or all recordings if there is none. Throws Failure (usage).
[[nodiscard]] fleet::Shard parse_shard(const std::string& text);

}  // namespace proofmass::app
