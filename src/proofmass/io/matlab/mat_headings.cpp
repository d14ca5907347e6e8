#include "proofmass/io/matlab/mat_headings.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <map>

#include "proofmass/io/arrays/recording.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::matlab {
namespace {

using Columns = std::vector<std::vector<double>>;

/// Headings for the columns of a matrix; `prefix` is empty if its name is uninformative.
std::vector<std::string> headings_of(std::string_view prefix, std::size_t width, bool is_timed) {
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  const std::size_t first = is_timed ? 1 : 0;
  std::vector<std::string> headings;
  if (is_timed) headings.emplace_back("time (s)");
  for (std::size_t c = first; c < width; ++c) {
    const bool is_triad = width - first == axes.size();
    if (is_triad)
      headings.push_back(fmt::format("{}{}{}", prefix, prefix.empty() ? "" : "_", axes[c - first]));
    else
      headings.push_back(fmt::format("{} {}", prefix.empty() ? "column" : prefix, c + 1));
  }
  return headings;
}

}  // namespace

std::vector<std::string> headings_of(const std::vector<Table>& tables,
                                     const std::vector<Columns>& values,
                                     const ReadOptions& options) {
  const auto is_matrix = [](const Table& table) { return table.width > 1; };
  const auto matrices = std::ranges::count_if(tables, is_matrix);
  const auto is_named = [&](const Table& table) {
    return kind_of(table) == TableKind::other || is_asked_for(table, options);
  };
  if (tables.size() == 1 && matrices == 1 && !is_named(tables[0])) return {};
  std::vector<std::string> vectors;
  for (const Table& table : tables)
    if (!is_matrix(table)) vectors.push_back(table.name());
  bool is_timed = time_among(vectors, options).has_value();
  std::vector<std::string> headings;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::string name = tables[i].name();
    if (!is_matrix(tables[i])) {
      headings.push_back(name);
      continue;
    }
    const bool has_time = !is_timed && ascends(values[i][0]);
    is_timed = is_timed || has_time;
    const bool is_shown = matrices > 1 || is_named(tables[i]);
    std::ranges::move(headings_of(is_shown ? name : "", tables[i].width, has_time),
                      std::back_inserter(headings));
  }
  return headings;
}

void note_headings(const Catalogue& catalogue,
                   const std::vector<Table>& tables,
                   std::vector<std::string>& headings) {
  std::map<std::string_view, std::string_view> texts;
  for (const Text& text : catalogue.texts) texts.emplace(text.path, text.text);
  const auto sibling = [&](std::string_view about, const std::string& path) {
    const auto found = texts.find(fmt::format("{}.{}", about, path));
    return found == texts.end() ? std::string{} : shown(found->second);
  };
  std::size_t column = 0;
  for (const Table& table : tables) {
    const std::size_t at = column;
    column += table.width;
    if (table.width > 1 || at >= headings.size()) continue;
    const std::string name = sibling("names", table.array->path);
    const std::string unit = sibling("units", table.array->path);
    if (!name.empty()) headings[at] = name;
    if (!unit.empty()) headings[at] += fmt::format(" ({})", unit);
  }
}

}  // namespace proofmass::io::matlab
