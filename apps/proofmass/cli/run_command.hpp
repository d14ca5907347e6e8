#pragma once

namespace proofmass::app {

/// Parses the command line, runs the verb, and prints an error message on standard error if it
/// fails. Returns the exit status.
[[nodiscard]] int run_command(int argc, char** argv);

}  // namespace proofmass::app
