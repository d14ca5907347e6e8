#pragma once

#include <optional>

#include "verb.hpp"

namespace proofmass::app {

/// Parses the command line and the configuration file that it may name, into the flags of the
/// returned verb. Prints --help, --version and shell completions itself and returns nullopt for
/// them. Throws Failure.
[[nodiscard]] std::optional<Verb> parse_command_line(int argc, char** argv);

}  // namespace proofmass::app
