#include "cli/help_format.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <sys/ioctl.h>
#include <unistd.h>

namespace proofmass::app {
namespace {

constexpr std::size_t name_width = 30;

// Breaks text into lines of at most `width` bytes.
std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (lines.empty() || lines.back().size() + 1 + word.size() > width)
      lines.push_back(word);
    else
      lines.back() += " " + word;
  }
  return lines;
}

// "FILE.csv" from "FILE.csv:{a,b}" and "N" from "N:INT in [4 - 360]": without the text of a check.
std::string kind_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::string names_in(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  return fmt::format("{}", fmt::join(names, ", "));
}

bool mentions(const std::string& text, const std::vector<std::string>& words) {
  return std::ranges::all_of(
      words, [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

std::string description_of(const CLI::Option& option) {
  std::string text = option.get_description();
  const std::vector<std::string> values = listed_values(option);
  if (!values.empty() && !mentions(text + kind_of(option), values))
    text += fmt::format(": {}", fmt::join(values, ", "));
  std::vector<std::string> notes;
  if (option.nonpositional() && option.get_required()) notes.emplace_back("required");
  if (!option.get_needs().empty()) notes.push_back("needs " + names_in(option.get_needs()));
  if (!option.get_excludes().empty())
    notes.push_back("not with " + names_in(option.get_excludes()));
  if (!option.get_default_str().empty()) notes.push_back("default " + option.get_default_str());
  return notes.empty() ? text : text + fmt::format(" ({})", fmt::join(notes, "; "));
}

bool has_input_flags(const CLI::App& verb) {
  return std::ranges::count(verb.get_groups(), input_group) > 0;
}

}  // namespace

std::string HelpFormat::entry(const std::string& name, const std::string& what) const {
  const std::size_t width = std::max<std::size_t>(width_, name_width + 20) - name_width;
  std::string text = "  " + name;
  const bool fits = text.size() + 2 <= name_width;
  if (!fits) text += "\n";
  std::size_t column = fits ? text.size() : 0;
  for (const std::string& line : wrapped(what, width)) {
    text += std::string(name_width - column, ' ') + line + "\n";
    column = 0;
  }
  if (text.back() != '\n') text += "\n";
  return text;
}

std::string HelpFormat::make_description(const CLI::App* app) const {
  return fmt::format("{}\n", fmt::join(wrapped(app->get_description(), width_), "\n"));
}

std::string HelpFormat::make_positionals(const CLI::App* app) const {
  return shows_input_ ? std::string() : CLI::Formatter::make_positionals(app);
}

std::string HelpFormat::make_group(std::string group,
                                   bool is_positional,
                                   std::vector<const CLI::Option*> options) const {
  if (shows_input_ != (group == input_group)) return {};
  return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = make_option_name(option, is_positional);
  if (!is_positional && option->get_type_size() != 0) name += " " + kind_of(*option);
  return entry(name, description_of(*option));
}

// Usual notation of positionals: "FILE...", "[RIG]".
std::string HelpFormat::make_option_usage(const CLI::Option* option) const {
  const std::string name = option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
  return option->get_required() ? name : "[" + name + "]";
}

std::string HelpFormat::make_subcommand(const CLI::App* verb) const {
  return entry(verb->get_name(), verb->get_description());
}

std::string HelpFormat::make_footer(const CLI::App* app) const {
  if (shows_input_) return {};
  const bool refers = has_input_flags(*app);
  std::string text;
  if (refers)
    text = fmt::format(
        "How the recording is read (--rate, --unit, --channel, --from, --sensor ...):\n"
        "  proofmass {} --{}\n\n",
        app->get_name(), input_help_flag);
  return text + CLI::Formatter::make_footer(app);
}

std::size_t help_width() {
  constexpr std::size_t usual = 80, widest = 100, narrowest = 50;
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return usual;
  return std::clamp<std::size_t>(size.ws_col, narrowest, widest);
}

// "NAME:{tumble,static}": CLI11's description of a membership check.
std::vector<std::string> listed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t from = type.find('{'), to = type.rfind('}');
  if (from == std::string::npos || to == std::string::npos || to <= from + 1) return {};
  return CLI::detail::split(type.substr(from + 1, to - from - 1), ',');
}

}  // namespace proofmass::app
