#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/completion.hpp"
#include "cli/config_file.hpp"
#include "cli/exit_status.hpp"
#include "cli/help_format.hpp"
#include "cli/output.hpp"
#include "cli/plain_text.hpp"
#include "cli/provenance.hpp"
#include "cli/usage_error.hpp"
#include "fleet/arguments.hpp"
#include "fleet/command.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/core/version.hpp"

namespace proofmass::app {
namespace {

// The value of --config, if given.
std::string config_path(const std::vector<std::string>& arguments) {
  constexpr std::string_view flag = "--config";
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] == flag && k + 1 < arguments.size()) return arguments[k + 1];
    if (arguments[k].starts_with(std::string(flag) + "="))
      return arguments[k].substr(flag.size() + 1);
  }
  return {};
}

bool is_given(const CLI::Option& option, const std::vector<std::string>& arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name.starts_with("--")) return option.check_lname(name.substr(2));
    return name.size() > 1 && name.front() == '-' && option.check_sname(name.substr(1, 1));
  });
}

CLI::App* find_verb(CLI::App& app, const std::string& name) {
  const auto verbs = app.get_subcommands([&](CLI::App* verb) { return verb->get_name() == name; });
  return verbs.empty() ? nullptr : verbs.front();
}

bool known_to_any(CLI::App& app, const std::string& flag) {
  const auto verbs = app.get_subcommands([](CLI::App*) { return true; });
  return std::any_of(verbs.begin(), verbs.end(), [&](CLI::App* verb) {
    return verb->get_option_no_throw("--" + flag) != nullptr;
  });
}

// The option to which an entry applies; nullptr if it does not apply to this verb.
const CLI::Option* option_for(CLI::App& app,
                              CLI::App& verb,
                              const ConfigEntry& entry,
                              const std::string& place) {
  if (!entry.verb.empty() && find_verb(app, entry.verb) == nullptr) {
    throw Failure(usage, place + "[" + entry.verb + "] is not a verb");
  }
  if (!entry.verb.empty() && entry.verb != verb.get_name()) return nullptr;
  const bool about_itself = entry.flag == "config" || entry.flag == "help";
  const CLI::Option* option = about_itself ? nullptr : verb.get_option_no_throw("--" + entry.flag);
  const bool elsewhere = !about_itself && entry.verb.empty() && known_to_any(app, entry.flag);
  if (option == nullptr && !elsewhere) {
    throw Failure(usage, fmt::format("{}{} has no flag '{}': see proofmass {} --help", place,
                                     verb.get_name(), entry.flag, verb.get_name()));
  }
  return option;
}

// The entry as words of a command line.
std::vector<std::string> as_arguments(const CLI::Option& option,
                                      const ConfigEntry& entry,
                                      const std::string& place) {
  std::vector<std::string> arguments;
  const bool is_switch = option.get_items_expected_max() == 0;
  for (const std::string& value : entry.values) {
    if (is_switch && value != "true" && value != "false") {
      throw Failure(usage, place + entry.flag + ": expected true or false, not '" + value + "'");
    }
    if (!is_switch) arguments.push_back("--" + entry.flag + "=" + value);
    if (is_switch && value == "true") arguments.push_back("--" + entry.flag);
  }
  return arguments;
}

// Flags from the configuration file, inserted before the given ones, which take precedence.
std::vector<std::string> configured(CLI::App& app,
                                    CLI::App& verb,
                                    const std::vector<std::string>& arguments) {
  std::vector<std::string> more;
  const std::string path = config_path(arguments);
  if (path.empty()) return more;
  for (const ConfigEntry& entry : read_config(path)) {
    const std::string place = fmt::format("{}: line {}: ", path, entry.line);
    const CLI::Option* option = option_for(app, verb, entry, place);
    if (option == nullptr || is_given(*option, arguments)) continue;
    for (std::string& argument : as_arguments(*option, entry, place)) {
      more.push_back(std::move(argument));
    }
  }
  return more;
}

std::vector<std::string> with_config(CLI::App& app, std::vector<std::string> arguments) {
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    CLI::App* verb = find_verb(app, arguments[k]);
    if (verb == nullptr) continue;
    const std::vector<std::string> more = configured(app, *verb, arguments);
    arguments.insert(arguments.begin() + static_cast<std::ptrdiff_t>(k) + 1, more.begin(),
                     more.end());
    break;
  }
  return arguments;
}

const Verb& verb_named(const std::vector<Verb>& verbs, const std::string& name) {
  return *std::ranges::find(verbs, name, [](const Verb& one) { return one.text.name; });
}

// The first word that is not a flag, which must be a verb.
std::string first_word(const std::vector<std::string>& arguments) {
  const auto word = std::ranges::find_if(
      arguments, [](const std::string& argument) { return !argument.starts_with('-'); });
  return word == arguments.end() ? std::string() : *word;
}

// "help wheel" as "wheel --help", nothing as "--help", "version" as "--version".
std::vector<std::string> as_flags(std::vector<std::string> arguments) {
  if (arguments.empty()) return {"--help"};
  if (arguments.front() == "version" || arguments.front() == "-V") return {"--version"};
  if (arguments.front() != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

void add_verbs(CLI::App& app, const std::vector<Verb>& verbs) {
  const std::string name = std::string("--") + input_help_flag;
  const std::string help = "list the flags for reading recordings";
  for (const Verb& verb : verbs) {
    CLI::App& flags = *app.add_subcommand(verb.text.name, verb.text.help);
    flags.group(verb.text.group);
    verb.add_flags(flags);
    if (std::ranges::count(flags.get_groups(), input_group) > 0) flags.add_flag(name, help);
  }
}

// Files that are read or updated; any other option of this type names a file to be written.
bool names_input(const CLI::Option& option) {
  if (option.get_positional())
    return option.get_type_name() != "WORD" && !option.get_type_name().starts_with("WORD:");
  for (const char* written : {"json", "report", "page", "output", "update-sensor"})
    if (option.check_lname(written)) return false;
  return option.get_type_name().starts_with("FILE");
}

// Removes passwords.
std::vector<std::string> shown(std::vector<std::string> words) {
  for (std::string& word : words)
    if (word.find("password=") != std::string::npos) word = acquire::shown_uri(word);
  return words;
}

// The call of the verb, as parsed.
std::shared_ptr<Invocation> invocation(const CLI::App& verb,
                                       const std::vector<std::string>& arguments) {
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<std::string> files;
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0) continue;
    const auto values = shown(option->results());
    if (names_input(*option)) files.insert(files.end(), values.begin(), values.end());
    if (!option->get_positional())
      options.emplace_back("--" + option->get_single_name(),
                           fmt::format("{}", fmt::join(values, ",")));
  }
  return std::make_shared<Invocation>("proofmass " + quoted(shown(arguments)), std::move(options),
                                      std::move(files));
}

// Reduces empty lines to one at a time, and none at the end.
std::string without_empty_lines(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c != '\n' || !out.ends_with("\n\n")) out += c;
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

// True if help was requested and printed.
bool print_help(CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* verb = find_verb(app, first_word(arguments));
  const auto asks_for = [&](const std::string& flag) {
    return std::ranges::count(arguments, flag) > 0;
  };
  const bool for_input = verb != nullptr && asks_for(std::string("--") + input_help_flag);
  if (!for_input && !asks_for("--help") && !asks_for("-h")) return false;
  HelpFormat format(help_width(), for_input);
  format.label("SUBCOMMAND", "VERB");
  const std::string name = verb == nullptr ? "proofmass" : "proofmass " + verb->get_name();
  const CLI::App* about = verb == nullptr ? &app : verb;
  const std::string help = format.make_help(about, name, CLI::AppFormatMode::Normal);
  print_out(terminal_text(without_empty_lines(help)));
  return true;
}

}  // namespace

std::optional<Verb> parse_command_line(int argc, char** argv) {
  CLI::App app(
      "Puts an accelerometer to the proof: from raw voltages to angle and position with honest "
      "error bars.",
      "proofmass");
  app.set_version_flag("--version", fmt::format("proofmass {}", version()));
  app.require_subcommand(1);
  app.footer("Help on a verb: proofmass help VERB");
  const std::vector<Verb> verbs = all_verbs();
  add_verbs(app, verbs);
  if (argc > 1 && argv[1] == completion_verb) {
    print_out(completions(app, {argv + 2, argv + argc}));
    return std::nullopt;
  }
  std::vector<std::string> arguments = as_flags({argv + 1, argv + argc});
  const std::string word = first_word(arguments);
  if (!word.empty() && find_verb(app, word) == nullptr)
    throw Failure(usage, unknown_verb(app, word));
  if (print_help(app, arguments)) return std::nullopt;
  const std::vector<std::string> typed = arguments;
  if (word == fleet_name) take_verb_flags(app, verb_named(verbs, word), arguments);
  arguments = with_config(app, std::move(arguments));
  std::ranges::reverse(arguments);  // CLI11 expects the reverse order
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::CallForVersion& version_asked) {
    print_out(std::string(version_asked.what()) + "\n");
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    throw Failure(usage, usage_error(app, error));
  }
  const CLI::App& chosen = *app.get_subcommands().front();
  const Verb& verb = verb_named(verbs, chosen.get_name());
  OutputFlags& output = *verb.output;
  if (output.output == "-" && output.json == "-")
    throw Failure(usage, "--output - and --json - cannot both have standard output: name a file");
  if (!output.json.empty() || !output.report.empty()) output.invocation = invocation(chosen, typed);
  return verb;
}

}  // namespace proofmass::app
