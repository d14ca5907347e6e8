#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

// A command line that makes no sense, in one line that says what was probably meant.
namespace proofmass::app {

/// The candidate fewest edits away, if they are few for the length of the word.
[[nodiscard]] std::optional<std::string> nearest(const std::string& word,
                                                 const std::vector<std::string>& candidates);

/// "no verb 'wheal': did you mean wheel?"
[[nodiscard]] std::string unknown_verb(const CLI::App& app, const std::string& word);

/// What CLI11 objected to, and the help to look at.
[[nodiscard]] std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace proofmass::app
