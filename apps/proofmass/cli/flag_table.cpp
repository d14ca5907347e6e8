#include "cli/flag_table.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <regex>

#include "cli/help_format.hpp"
#include "proofmass/report/json.hpp"
#include "verb.hpp"

namespace proofmass::app {
namespace {

using report::Array;
using report::Object;
using report::Value;

// Flags of the command, not of the analysis.
constexpr std::array<std::string_view, 14> of_the_command{
    "help",    "help-input", "json",   "report",        "page",   "output",       "quiet",
    "verbose", "strict",     "config", "update-sensor", "memory", "print-config", "pyramid"};

// "FILE.toml" from "FILE.toml:…", to which a check appended its text.
std::string plain_type(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

// Default value stated in the help: "oadev (default), adev", "(default 16)", "(default: all)".
std::string default_in(const CLI::Option& option) {
  if (!option.get_default_str().empty()) return option.get_default_str();
  const std::string& help = option.get_description();
  std::smatch found;
  if (std::regex_search(help, found, std::regex(R"(\(default:? ([^);,]+)\))"))) return found[1];
  if (std::regex_search(help, found, std::regex(R"(([\w./^-]+) \(default\))"))) return found[1];
  return {};
}

Value option_row(const CLI::Option& option) {
  const bool is_switch = option.get_items_expected_max() == 0;
  const std::string type = is_switch ? "" : plain_type(option);
  return Object{{"name", option.get_lnames().front()},
                {"group", option.get_group()},
                {"help", option.get_description()},
                {"type", type},
                {"choices", report::array_of(listed_values(option))},
                {"default", default_in(option)},
                {"switch", is_switch},
                {"many", !is_switch && option.get_expected_max() > 1},
                {"file", type.starts_with("FILE")},
                {"required", option.get_required()}};
}

bool has(const CLI::App& flags, const char* name) {
  return flags.get_option_no_throw(name) != nullptr;
}

bool takes_files(const CLI::App& flags) {
  return std::ranges::any_of(flags.get_options(),
                             [](const CLI::Option* option) { return option->get_positional(); });
}

Value verb_row(const Verb& verb, const CLI::App& flags) {
  Array options;
  bool many_files = false;
  for (const CLI::Option* option : flags.get_options()) {
    if (option->get_positional()) many_files = option->get_expected_max() > 1;
    const bool is_hidden = option->get_group().empty();
    if (option->get_lnames().empty() || is_hidden) continue;
    const std::string& name = option->get_lnames().front();
    if (std::ranges::find(of_the_command, name) == of_the_command.end())
      options.push_back(option_row(*option));
  }
  return Object{{"name", verb.text.name},           {"group", verb.text.group},
                {"help", verb.text.help},           {"reads", "recordings"},
                {"many_files", many_files},         {"page", true},
                {"series", has(flags, "--output")}, {"sensor_file", has(flags, "--update-sensor")},
                {"options", std::move(options)}};
}

// An action of `sensor`, as a verb of its own.
struct SensorAction {
  const char *name, *help;
  bool is_export, many_files;
};
constexpr std::array<SensorAction, 3> sensor_actions{
    {{"sensor show", "figures of a sensor file, with their uncertainty and origin", false, false},
     {"sensor diff", "what has changed between two sensor files, by more than its uncertainty",
      false, true},
     {"sensor export", "a sensor file for visual-inertial calibration or firmware", true, false}}};

Value action_row(const SensorAction& action, const CLI::App& flags) {
  Array options;
  for (const CLI::Option* option : flags.get_options())
    if (action.is_export && option->get_group() == "Export") options.push_back(option_row(*option));
  return Object{{"name", action.name},
                {"group", "Sensor files"},
                {"help", action.help},
                {"reads", "sensor_files"},
                {"many_files", action.many_files},
                {"page", !action.is_export},
                {"series", false},
                {"sensor_file", false},
                {"options", std::move(options)}};
}

}  // namespace

std::string flag_table() {
  Array rows;
  for (const Verb& verb : all_verbs()) {
    CLI::App flags;
    verb.add_flags(flags);
    // drive has a flag for each wheel, which a list of recordings does not fill in.
    if (verb.input != nullptr && has(flags, "--page") && takes_files(flags))
      rows.push_back(verb_row(verb, flags));
    if (verb.text.name == "sensor")
      for (const SensorAction& action : sensor_actions) rows.push_back(action_row(action, flags));
  }
  return report::json_text(Object{{"verbs", std::move(rows)}});
}

}  // namespace proofmass::app
