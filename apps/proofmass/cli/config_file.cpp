#include "cli/config_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>

#include "cli/exit_status.hpp"

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

namespace proofmass::app {
namespace {

// A scalar value as a command-line argument.
std::optional<std::string> argument(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto yes = node.value_exact<bool>()) return *yes ? "true" : "false";
  if (const auto whole = node.value_exact<std::int64_t>()) return std::to_string(*whole);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  return std::nullopt;
}

[[noreturn]] void refuse(const std::string& path, const toml::node& node, std::string_view key) {
  throw Failure(usage,
                fmt::format("{}: line {}: {}: expected a text, number, true, false or a list "
                            "of such",
                            path, node.source().begin.line, key));
}

ConfigEntry entry(const std::string& path,
                  const std::string& verb,
                  std::string_view key,
                  const toml::node& node) {
  ConfigEntry found{verb, std::string(key), {}, node.source().begin.line};
  std::replace(found.flag.begin(), found.flag.end(), '_', '-');
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& item : *list) {
      const auto text = argument(item);
      if (!text) refuse(path, node, key);
      found.values.push_back(*text);
    }
    return found;
  }
  const auto text = argument(node);
  if (!text) refuse(path, node, key);
  found.values.push_back(*text);
  return found;
}

toml::table parse(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    throw Failure(bad_input, path + ": cannot be read: give --config a TOML file that is there");
  }
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    throw Failure(bad_input, fmt::format("{}: line {}: {}", path, error.source().begin.line,
                                         error.description()));
  }
}

}  // namespace

std::vector<ConfigEntry> read_config(const std::string& path) {
  std::vector<ConfigEntry> entries;
  for (const auto& [key, node] : parse(path)) {
    if (const toml::table* verb = node.as_table()) {
      for (const auto& [flag, value] : *verb) {
        entries.push_back(entry(path, std::string(key.str()), flag.str(), value));
      }
    } else {
      entries.push_back(entry(path, "", key.str(), node));
    }
  }
  return entries;
}

}  // namespace proofmass::app
