#pragma once

#include <optional>

#include "verb.hpp"

namespace proofmass::app {

/// Reads the command line and the configuration file that it may name, into the flags of the verb
/// that it returns. --help and --version are printed here, and have no verb; nor has what a shell
/// asks for at Tab. Throws Failure.
[[nodiscard]] std::optional<Verb> parse_command_line(int argc, char** argv);

}  // namespace proofmass::app
