#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace proofmass::app {

inline constexpr const char* fleet_verb = "fleet";

/// Takes the flags that only the verb behind "fleet" knows, with their values, out of the
/// arguments. A flag that both know is the fleet's.
[[nodiscard]] std::vector<std::string> take_verb_flags(const CLI::App& app,
                                                       std::vector<std::string>& arguments);

}  // namespace proofmass::app
