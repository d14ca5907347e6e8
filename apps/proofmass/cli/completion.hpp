#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

// Shell completion. The scripts in completions/ call `proofmass __complete WORD...`, so that they
// contain no verbs or flags themselves.
namespace proofmass::app {

inline constexpr std::string_view completion_verb = "__complete";

/// Candidates for the last of `words` (those after the program's name), one per line: "WORD\tWHAT".
/// Lines that begin with a colon give other completions:
///   :files          any file
///   :ending toml    a file with this extension, if there is one
///   :prefix replay: a file name after this prefix
///   :text WHAT      free text
[[nodiscard]] std::string completions(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace proofmass::app
