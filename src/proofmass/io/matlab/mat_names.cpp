#include "proofmass/io/matlab/mat_names.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "proofmass/io/names.hpp"

namespace proofmass::io::matlab {
namespace {

constexpr std::size_t longest_name = 63;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_keyword(std::string_view name) {
  constexpr std::array<std::string_view, 20> keywords{
      "break",      "case",   "catch",    "classdef", "continue", "else",      "elseif",
      "end",        "for",    "function", "global",   "if",       "otherwise", "parfor",
      "persistent", "return", "spmd",     "switch",   "try",      "while"};
  return std::ranges::find(keywords, name) != keywords.end();
}

/// Invalid characters become underscores, never two in a row.
std::string legal(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (is_letter(c) || (c >= '0' && c <= '9'))
      name += c;
    else if (!name.ends_with('_') && !name.empty())
      name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  if (name.empty()) name = "channel";
  if (!is_letter(name.front()) || is_keyword(name)) name.insert(0, "x_");
  return name.substr(0, longest_name);
}

}  // namespace

std::string Names::name_for(std::string_view text) {
  const std::string wish = legal(text);
  std::string name = wish;
  for (std::size_t k = 2; !taken_.insert(lower(name)).second; ++k) {
    const std::string tail = fmt::format("_{}", k);
    name = wish.substr(0, longest_name - tail.size()) + tail;
  }
  return name;
}

}  // namespace proofmass::io::matlab
