#pragma once

#include <any>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/common_flags.hpp"
#include "cli/distinct_files.hpp"

namespace CLI {
class App;
}

namespace proofmass::app {

struct VerbText {
  std::string name, group, help;
};

/// A verb of the program, with the command that its flags fill in.
struct Verb {
  VerbText text;
  std::function<void(CLI::App& verb)> add_flags;
  std::function<Files()> files;  ///< named on the command line
  std::function<void()> run;     ///< throws Failure
  OutputFlags* output = nullptr;
  InputFlags* input = nullptr;  ///< null: reads no recordings
  std::any command{};           ///< std::shared_ptr to the command that the flags fill in
};

/// `add_flags` binds the flags to a command, `run` executes it. The command has a member `output`,
/// and `input` if it reads recordings.
template <class Command>
[[nodiscard]] Verb make_verb(VerbText text,
                             void (*add_flags)(CLI::App&, Command&),
                             void (*run)(const Command&)) {
  const auto command = std::make_shared<Command>();
  Verb verb{.text = std::move(text),
            .add_flags = [=](CLI::App& app) { add_flags(app, *command); },
            .files = [=] { return files_of(*command); },
            .run = [=] { run(*command); },
            .output = &command->output,
            .command = command};
  if constexpr (requires { command->input; }) verb.input = &command->input;
  return verb;
}

/// All verbs, in the order of the help.
[[nodiscard]] std::vector<Verb> all_verbs();

}  // namespace proofmass::app
