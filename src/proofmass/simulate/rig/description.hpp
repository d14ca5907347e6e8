#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <toml++/toml.h>
#include <utility>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/simulate/rig.hpp"
#include "proofmass/simulate/rig/converter.hpp"

// Shared by the descriptions of rig and procedure (TOML): visitors that fill options from text and
// print them, for functions visit(key, member, unit of the file in SI, comment).
namespace proofmass::simulate {

/// The words for an enumeration's values in a description; one overload each.
[[nodiscard]] inline auto choices(RigOutput /*which*/) {
  return output_words;
}

namespace description {

/// Thrown while a description is read; parse() converts it to the Result's error.
struct Failure {
  Error error;
};

[[noreturn]] void fail(const toml::node& node,
                       std::string_view key,
                       std::string_view why,
                       std::vector<Advice> advice = {});

/// Fills a member from a node; one overload for each type of member.
struct Fill {
  const toml::node& node;
  std::string_view key;
  double to_si;

  void operator()(double& member) const;
  void operator()(bool& member) const;
  void operator()(int& member) const;
  void operator()(std::uint64_t& member) const;
  template <std::size_t N>
  void operator()(std::array<double, N>& member) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != N)
      fail(node, key, "must be an array of " + std::to_string(N) + " numbers");
    for (std::size_t i = 0; i < N; ++i) Fill{(*array)[i], key, to_si}(member[i]);
  }
  template <class Choice>
  void operator()(Choice& member) const {
    std::string words;
    for (const auto& [value, word] : choices(member)) {
      words += (words.empty() ? "\"" : ", \"") + std::string(word) + "\"";
      if (node.value<std::string_view>() != word) continue;
      member = value;
      return;
    }
    fail(node, key, "must be one of " + words);
  }
};

/// Visits a section's fields, and removes the entries it has read from the table.
struct Take {
  toml::table& table;

  template <class Member>
  void operator()(std::string_view key, Member& member, double to_si, const auto& /*why*/) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    Fill{*node, key, to_si}(member);
    table.erase(key);
  }
};

void must_be_empty(const toml::table& table, std::string_view section);

/// Reads [name], if present.
template <class Read>
void read_section(toml::table& root, std::string_view name, Read read) {
  toml::node* node = root.get(name);
  if (node == nullptr) return;
  if (!node->is_table()) fail(*node, name, "must be a section, [" + std::string(name) + "]");
  read(Take{*node->as_table()});
  must_be_empty(*node->as_table(), "[" + std::string(name) + "]");
  root.erase(name);
}

/// Reads all of [[name]], if present; they replace the defaults.
template <class Item, class Read>
void read_list(toml::table& root, std::string_view name, std::vector<Item>& items, Read read) {
  toml::node* node = root.get(name);
  if (node == nullptr) return;
  toml::array* array = node->as_array();
  if (array == nullptr || !array->is_array_of_tables())
    fail(*node, name, "must be a list of sections, [[" + std::string(name) + "]]");
  items.clear();
  for (toml::node& element : *array) {
    read(items.emplace_back(), Take{*element.as_table()});
    must_be_empty(*element.as_table(), "[[" + std::string(name) + "]]");
  }
  root.erase(name);
}

[[nodiscard]] std::string value_text(double member, double to_si);
[[nodiscard]] std::string value_text(bool member, double to_si);
[[nodiscard]] std::string value_text(int member, double to_si);
[[nodiscard]] std::string value_text(std::uint64_t member, double to_si);
template <std::size_t N>
[[nodiscard]] std::string value_text(const std::array<double, N>& member, double to_si) {
  std::string text;
  for (const double v : member) text += (text.empty() ? "" : ", ") + value_text(v, to_si);
  return "[" + text + "]";
}
template <class Choice>
[[nodiscard]] std::string value_text(const Choice& member, double /*to_si*/) {
  for (const auto& [value, word] : choices(member))
    if (value == member) return "\"" + std::string(word) + "\"";
  return {};
}

/// "key = value      # why" on one line.
[[nodiscard]] std::string line(std::string_view key, std::string_view value, std::string_view why);

struct Print {
  std::string& out;
  template <class Member>
  void operator()(std::string_view key,
                  const Member& member,
                  double to_si,
                  std::string_view why) const {
    out += line(key, value_text(member, to_si), why);
  }
};

/// Parses TOML and passes its root to `read`, which may throw Failure. Errors carry `name`.
template <class Options>
[[nodiscard]] Result<Options> parse(std::string_view text,
                                    std::string_view name,
                                    const auto& read) {
  try {
    toml::table root = toml::parse(text);
    Options options = read(root);
    if (const Status checked = check(options); !checked) return checked.error().at(name);
    return options;
  } catch (const Failure& failure) {
    return failure.error.at(name);
  } catch (const toml::parse_error& error) {
    return Error{Errc::corrupt, std::string(name) + ": line " +
                                    std::to_string(error.source().begin.line) +
                                    ": no TOML: " + std::string(error.description())};
  }
}

/// A file's text; `what` is the kind of description.
/// Errors: unreadable.
[[nodiscard]] Result<std::string> text_of(const std::string& path, std::string_view what);

}  // namespace description
}  // namespace proofmass::simulate
