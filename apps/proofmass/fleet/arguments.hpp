#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "verb.hpp"

namespace proofmass::app {

/// Takes the flags that only the verb behind "fleet" has, with their values, out of the arguments
/// and into the command of `fleet`. A flag that both have is the fleet's.
void take_verb_flags(const CLI::App& app, const Verb& fleet, std::vector<std::string>& arguments);

}  // namespace proofmass::app
