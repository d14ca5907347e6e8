#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

// What a shell may offer where the user presses Tab. The scripts in completions/ ask for it by
// `proofmass __complete WORD...`, so that they know nothing of verbs and flags themselves.
namespace proofmass::app {

inline constexpr std::string_view completion_verb = "__complete";

/// What may stand in place of the last of `words`, those behind the program's name: one a line,
/// "WORD\tWHAT". Lines that begin with a colon say what else there may be:
///   :files          a file
///   :ending toml    of such a name, if there is one
///   :prefix replay: whose name stands behind this
///   :text WHAT      what only the user knows
[[nodiscard]] std::string completions(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace proofmass::app
