#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "verb.hpp"

namespace proofmass::app {

/// Moves the flags known only to the verb after "fleet", with their values, from the arguments into
/// the command of `fleet`. A flag that both have belongs to `fleet`.
void take_verb_flags(const CLI::App& app, const Verb& fleet, std::vector<std::string>& arguments);

}  // namespace proofmass::app
