#pragma once

#include <any>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.hpp"
#include "errors.hpp"

// Options of Python functions correspond to flags of the command, whose parser checks them.
namespace proofmass::python {

/// The verb with its flags, parsed from words of a command line: "noise", "array", "--rate=100".
/// Throws Failure.
[[nodiscard]] inline app::Verb parsed_verb(std::vector<std::string> words) {
  words.insert(words.begin(), "proofmass");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  auto verb = app::parse_command_line(static_cast<int>(arguments.size()), arguments.data());
  if (!verb) refuse("this asks for help, not for an analysis");
  return std::move(*verb);
}

/// The command struct of a verb of known type.
template <class C>
[[nodiscard]] C parsed(std::vector<std::string> words) {
  return *std::any_cast<std::shared_ptr<C>>(parsed_verb(std::move(words)).command);
}

}  // namespace proofmass::python
