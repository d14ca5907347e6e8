#include "proofmass/serve/analysis_arguments.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <optional>

namespace proofmass::serve {
namespace {

using nlohmann::json;

Error refused(std::string what) {
  return {Errc::invalid_argument, std::move(what)};
}

// The entry of a list, which is a member of `table`, by its name.
const json* named(const json& table, const char* list, const std::string& name) {
  const auto entries = table.find(list);
  if (entries == table.end()) return nullptr;
  const auto found = std::ranges::find_if(
      *entries, [&](const json& one) { return one.value("name", "") == name; });
  return found == entries->end() ? nullptr : &*found;
}

// A value as a word of the command line; none where it is no text, number or switch.
std::optional<std::string> word_of(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  return std::nullopt;
}

Status add_option(const json& option,
                  const json& value,
                  const Folder& folder,
                  std::vector<std::string>& arguments) {
  const std::string flag = "--" + option.value("name", "");
  if (option.value("switch", false)) {
    if (!value.is_boolean()) return refused(flag + ": expected true or false");
    if (value.get<bool>()) arguments.push_back(flag);
    return Done{};
  }
  const json values = value.is_array() ? value : json::array({value});
  if (values.size() > 1 && !option.value("many", false))
    return refused(flag + ": expected one value");
  for (const json& one : values) {
    const auto word = word_of(one);
    if (!word || word->find('\0') != std::string::npos || word->find('\n') != std::string::npos)
      return refused(flag + ": expected a text or a number");
    if (option.value("file", false)) {
      const auto inside = folder.existing(*word);
      if (!inside) return inside.error().at(flag);
      arguments.push_back(flag + "=" + *inside);
    } else {
      arguments.push_back(flag + "=" + *word);
    }
  }
  return Done{};
}

Status add_files(const json& verb,
                 const json& asked,
                 const Folder& folder,
                 std::vector<std::string>& arguments) {
  const json files = asked.value("files", json::array());
  if (!files.is_array() || files.empty()) return refused("expected the name of a file");
  if (files.size() > 1 && !verb.value("many_files", false))
    return refused(verb.value("name", "") + ": takes one file");
  for (const json& file : files) {
    const auto name = folder.existing(file.is_string() ? file.get<std::string>() : "");
    if (!name) return name.error();
    arguments.push_back(plain_argument(*name));
  }
  return Done{};
}

bool is_plain(const std::string& word) {
  return !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) ||
           std::string_view("-_./=:,+").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

}  // namespace

Result<AnalysisArguments> analysis_arguments(const json& verbs,
                                             const json& asked,
                                             const Folder& folder) {
  if (!asked.is_object() || !asked.contains("verb") || !asked["verb"].is_string())
    return refused("expected {verb, files, options}");
  AnalysisArguments out{.verb = asked["verb"].get<std::string>(), .arguments = {}};
  const json* verb = named(verbs, "verbs", out.verb);
  if (verb == nullptr) return refused("no such analysis");
  // "sensor show" is a verb and its action.
  const std::size_t space = std::min(out.verb.find(' '), out.verb.size());
  out.arguments.push_back(out.verb.substr(0, space));
  if (space < out.verb.size()) out.arguments.push_back(out.verb.substr(space + 1));
  if (const Status s = add_files(*verb, asked, folder, out.arguments); !s) return s.error();
  const json options = asked.value("options", json::object());
  if (!options.is_object()) return refused("options: expected an object");
  for (const auto& [name, value] : options.items()) {
    const json* option = named(*verb, "options", name);
    if (option == nullptr) return refused(fmt::format("{} has no option {}", out.verb, name));
    if (const Status s = add_option(*option, value, folder, out.arguments); !s) return s.error();
  }
  out.writes_page = verb->value("page", false);
  out.writes_series = verb->value("series", false);
  const json wanted = asked.value("sensor_file", json(false));
  out.writes_sensor_file =
      verb->value("sensor_file", false) && wanted.is_boolean() && wanted.get<bool>();
  return out;
}

std::string plain_argument(const std::string& file) {
  return file.starts_with('-') ? "./" + file : file;
}

std::string shell_command(const std::vector<std::string>& arguments) {
  std::string text = "proofmass";
  for (const std::string& word : arguments) {
    text += ' ';
    if (is_plain(word)) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace proofmass::serve
