#pragma once

namespace proofmass::app {

/// Reads the command line, does what it asks for, and says on standard error why it could not.
/// Returns the exit status.
[[nodiscard]] int run_command(int argc, char** argv);

}  // namespace proofmass::app
