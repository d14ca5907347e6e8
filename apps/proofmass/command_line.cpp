#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <memory>

#include "completion.hpp"
#include "config_file.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "proofmass/core/version.hpp"
#include "verb_flags.hpp"

namespace proofmass::app {
namespace {

// Names the positionals the way people do: "FILE...", "[RIG]".
class Formatter : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
    return option->get_required() ? name : "[" + name + "]";
  }
};

// The verbs, each bound to its command.
struct Commands {
  InspectCommand inspect;
  ConvertCommand convert;
  WheelCommand wheel;
  NoiseCommand noise;
  DriftCommand drift;
  CalibrateCommand calibrate;
  TumbleCommand tumble;
  TiltCommand tilt;
  TrackCommand track;
  TuneCommand tune;
  SimulateCommand simulate;
  BudgetCommand budget;
  RecordCommand record;
  RecoverCommand recover;
  SensorCommand sensor;
  ThesisCommand thesis;
};

// The value of --config, if it is given.
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

// The option that an entry is for; nullptr if it is none of this verb's business.
const CLI::Option* option_for(CLI::App& app,
                              CLI::App& verb,
                              const ConfigEntry& entry,
                              const std::string& place) {
  if (!entry.verb.empty() && find_verb(app, entry.verb) == nullptr) {
    throw Failure(usage, place + "[" + entry.verb + "] is no verb");
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

// The entry as it would stand on the command line.
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

// The flags that the configuration file adds to those given, which go before it.
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

std::vector<std::string> with_config(CLI::App& app, int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
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

Command chosen(CLI::App& app, Commands& commands) {
  if (app.got_subcommand("inspect")) return std::move(commands.inspect);
  if (app.got_subcommand("convert")) return std::move(commands.convert);
  if (app.got_subcommand("wheel")) return std::move(commands.wheel);
  if (app.got_subcommand("noise")) return std::move(commands.noise);
  if (app.got_subcommand("drift")) return std::move(commands.drift);
  if (app.got_subcommand("calibrate")) return std::move(commands.calibrate);
  if (app.got_subcommand("tumble")) return std::move(commands.tumble);
  if (app.got_subcommand("tilt")) return std::move(commands.tilt);
  if (app.got_subcommand("track")) return std::move(commands.track);
  if (app.got_subcommand("tune")) return std::move(commands.tune);
  if (app.got_subcommand("simulate")) return std::move(commands.simulate);
  if (app.got_subcommand("record")) return std::move(commands.record);
  if (app.got_subcommand("recover")) return std::move(commands.recover);
  if (app.got_subcommand("sensor")) return std::move(commands.sensor);
  if (app.got_subcommand("thesis")) return std::move(commands.thesis);
  return std::move(commands.budget);
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::optional<Command> parse_command_line(int argc, char** argv) {
  CLI::App app(
      "Puts an accelerometer to the proof: from raw readings to angle, turns and speed with "
      "honest error bars.",
      "proofmass");
  app.set_version_flag("--version", fmt::format("proofmass {}", version()));
  app.require_subcommand(1);
  app.formatter(std::make_shared<Formatter>());
  app.get_formatter()->column_width(34);
  app.footer("Each verb explains itself: proofmass VERB --help");
  Commands commands;
  add_flags(app, commands.inspect);
  add_flags(app, commands.convert);
  add_flags(app, commands.wheel);
  add_flags(app, commands.noise);
  add_flags(app, commands.drift);
  add_flags(app, commands.calibrate);
  add_flags(app, commands.tumble);
  add_flags(app, commands.tilt);
  add_flags(app, commands.track);
  add_flags(app, commands.tune);
  add_flags(app, commands.simulate);
  add_flags(app, commands.budget);
  add_flags(app, commands.record);
  add_flags(app, commands.recover);
  add_flags(app, commands.sensor);
  add_flags(app, commands.thesis);
  if (argc > 1 && argv[1] == completion_verb) {
    print_out(completions(app, {argv + 2, argv + argc}));
    return std::nullopt;
  }
  std::vector<std::string> arguments = with_config(app, argc, argv);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error, std::cout, std::cerr);
      return std::nullopt;
    }
    const auto used = app.get_subcommands();
    const std::string verb = used.empty() ? "" : used.front()->get_name() + " ";
    throw Failure(usage, fmt::format("{}: see proofmass {}--help", one_line(error.what()), verb));
  }
  return chosen(app, commands);
}

std::array<double, 3> parse_axis(const std::string& text) {
  const bool minus = text.starts_with('-');
  const std::string letter = text.substr(minus || text.starts_with('+') ? 1 : 0);
  const double sign = minus ? -1.0 : 1.0;
  if (letter == "x") return {sign, 0.0, 0.0};
  if (letter == "y") return {0.0, sign, 0.0};
  if (letter == "z") return {0.0, 0.0, sign};
  std::array<double, 3> axis{};
  const char* from = text.data();
  const char* end = from + text.size();
  bool good = true;
  for (std::size_t k = 0; k < 3 && good; ++k) {
    const auto [stop, error] = std::from_chars(from, end, axis[k]);
    good = error == std::errc() && std::isfinite(axis[k]) &&
           (k == 2 ? stop == end : stop != end && *stop == ',');
    from = stop + 1;
  }
  if (!good || std::hypot(axis[0], axis[1], axis[2]) == 0.0) {
    throw Failure(
        usage,
        "--spin-axis: expected x, y, z, -x, -y, -z or three numbers \"0,0,1\", not '" + text + "'");
  }
  return axis;
}

}  // namespace proofmass::app
