#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

// One-line messages for invalid command lines, with a suggestion.
namespace proofmass::app {

/// The candidate with the fewest edits, if they are few for the length of the word.
[[nodiscard]] std::optional<std::string> nearest(const std::string& word,
                                                 const std::vector<std::string>& candidates);

/// "no verb 'wheal': did you mean wheel?"
[[nodiscard]] std::string unknown_verb(const CLI::App& app, const std::string& word);

/// CLI11's objection, and a reference to the help.
[[nodiscard]] std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace proofmass::app
