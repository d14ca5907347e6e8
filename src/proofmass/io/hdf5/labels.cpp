#include "proofmass/io/hdf5/labels.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/column_names.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/hdf5/path.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/text/unit_in_text.hpp"

namespace proofmass::io::hdf5 {
namespace {

bool is_unit_name(std::string_view name) {
  constexpr std::array<std::string_view, 3> names{"unit", "units", "physicalunit"};
  return is_one_of(name, names);
}

bool is_exact_name(std::string_view name) {
  return name == "channel_name";
}

bool is_columns_name(std::string_view name) {
  constexpr std::array<std::string_view, 9> names{"columns",       "columnnames",  "labels",
                                                  "channels",      "channelnames", "axes",
                                                  "channellabels", "names",        "fields"};
  return is_one_of(name, names);
}

/// "x, y, z" as "x", "y", "z".
std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',' || c == ';')
      parts.emplace_back();
    else if (c != ' ' || !parts.back().empty())
      parts.back() += c;
  }
  return parts;
}

/// The texts of an attribute, one per column or one for all; empty if it is neither.
std::vector<std::string> for_columns(const Attribute& attribute, std::size_t width) {
  std::vector<std::string> texts = attribute.texts;
  if (texts.size() == 1 && width > 1 && split(texts[0]).size() == width) texts = split(texts[0]);
  if (texts.size() == 1) texts.resize(width, texts[0]);
  return texts.size() == width ? texts : std::vector<std::string>{};
}

/// Names listed in an attribute; an axis alone is prefixed with the dataset's name.
std::vector<std::string> listed_names(const Attribute& columns,
                                      std::size_t width,
                                      const std::string& stem) {
  std::vector<std::string> names = for_columns(columns, width);
  for (std::string& name : names) {
    const bool is_axis = name.size() == 1 && lower(name)[0] >= 'w' && lower(name)[0] <= 'z';
    if (is_axis) name = fmt::format("{}_{}", stem, name);
  }
  return names;
}

bool is_quaternion_name(std::string_view name) {
  const std::string bare = lower(name);
  return bare.starts_with("ori") || bare.find("quat") != std::string::npos ||
         bare.find("rot") != std::string::npos;
}

/// Headings of one file's tables.
class Labeller {
 public:
  Labeller(const Catalogue& catalogue, const std::vector<matlab::Table>& tables)
      : catalogue_(catalogue) {
    stems_.reserve(tables.size());
    for (const matlab::Table& table : tables)
      stems_.push_back(std::string(leaf_of(table.array->path)));
    // Twice: names made unique by their group may need the next group.
    for (int round = 0; round < 2; ++round) lengthen(tables);
  }

  /// `has_time`: the first column is the time, in seconds.
  std::vector<std::string> headings(const matlab::Table& table,
                                    std::size_t number,
                                    bool has_time,
                                    std::vector<Note>& notes) const {
    const std::string& path = table.array->path;
    auto [stem, name_unit] = read_label(stems_[number]);
    const Attribute* exact = table.width == 1 ? find(path, is_exact_name) : nullptr;
    if (exact != nullptr) {
      stem = exact->texts[0];
      name_unit = {};
    }
    const std::vector<std::string> names = column_names(table, stem, has_time);
    std::vector<std::string> units(table.width, std::string(name_unit.symbol));
    const Attribute* unit = find(path, is_unit_name);
    const auto given =
        unit != nullptr ? for_columns(*unit, table.width) : std::vector<std::string>{};
    std::string unread;
    for (std::size_t c = 0; c < given.size(); ++c) {
      if (const std::string symbol = unit_symbol(given[c]); !symbol.empty())
        units[c] = symbol;
      else if (!given[c].empty())
        unread = given[c];
    }
    if (!unread.empty())
      notes.push_back({Severity::info, fmt::format("{}: unit \"{}\" is not known", path, unread)});
    if (given.empty() && name_unit.symbol.empty()) use_unit_in_text(path, units, notes);
    if (has_time) units[0] = std::string("s");
    std::vector<std::string> headings;
    headings.reserve(table.width);
    for (std::size_t c = 0; c < table.width; ++c)
      headings.push_back(units[c].empty() ? names[c] : fmt::format("{} ({})", names[c], units[c]));
    return headings;
  }

  [[nodiscard]] bool has_columns(const matlab::Table& table) const {
    const Attribute* columns = find(table.array->path, is_columns_name);
    return columns != nullptr && table.width > 1 &&
           for_columns(*columns, table.width).size() == table.width;
  }

 private:
  const Attribute* find(std::string_view owner, bool (*matches)(std::string_view)) const {
    const auto found = std::ranges::find_if(catalogue_.attributes, [&](const auto& attribute) {
      return attribute.owner == owner && matches(attribute.name) && !attribute.texts.empty();
    });
    return found == catalogue_.attributes.end() ? nullptr : &*found;
  }

  /// Prefixes the group to uninformative and duplicate names.
  void lengthen(const std::vector<matlab::Table>& tables) {
    constexpr std::array<std::string_view, 12> idle{
        "x",     "y",     "z", "w", "data", "values", "value", "samples", "array", "block0values",
        "table", "signal"};
    const std::vector<std::string> before = stems_;
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (std::ranges::count(before, before[i]) < 2 && !is_one_of(before[i], idle)) continue;
      std::string_view above = tables[i].array->path;
      above = above.substr(0, above.size() - std::min(above.size(), before[i].size()));
      while (above.ends_with('/')) above.remove_suffix(1);
      if (!above.empty()) stems_[i] = fmt::format("{}_{}", leaf_of(above), before[i]);
    }
  }

  std::vector<std::string> column_names(const matlab::Table& table,
                                        const std::string& stem,
                                        bool has_time) const {
    if (table.width == 1) return {stem};
    if (has_columns(table))
      return listed_names(*find(table.array->path, is_columns_name), table.width, stem);
    std::vector<std::string> names;
    if (has_time) names.emplace_back("time");
    std::ranges::move(names_by_place(stem, table.width - names.size()), std::back_inserter(names));
    return names;
  }

  /// From the texts of the dataset and of its enclosing groups.
  void use_unit_in_text(std::string_view path,
                        std::vector<std::string>& units,
                        std::vector<Note>& notes) const {
    for (std::string_view owner = path;; owner = group_of(owner)) {
      for (const Attribute& attribute : catalogue_.attributes) {
        if (attribute.owner != owner) continue;
        for (const std::string& text : attribute.texts) {
          const std::string symbol = unit_in_text(text, leaf_of(path));
          if (symbol.empty()) continue;
          std::ranges::fill(units, symbol);
          notes.push_back(
              {Severity::info, fmt::format("{}: unit {}, as the text \"{}\" in the file "
                                           "says",
                                           path, symbol, attribute.name)});
          return;
        }
      }
      if (owner.empty()) return;
    }
  }

  const Catalogue& catalogue_;
  std::vector<std::string> stems_;
};

}  // namespace

std::vector<std::string> names_by_place(const std::string& stem, std::size_t width) {
  constexpr std::array<std::string_view, 4> axes{"w", "x", "y", "z"};
  if (width == 1) return {stem};
  const bool is_quaternion = width == 4 && is_quaternion_name(stem);
  std::vector<std::string> names;
  names.reserve(width);
  for (std::size_t c = 0; c < width; ++c)
    names.push_back(width == 3 || is_quaternion
                        ? fmt::format("{}_{}", stem, axes[axes.size() - width + c])
                        : fmt::format("{} {}", stem, c + 1));
  return names;
}

std::vector<std::string> headings_of(const Catalogue& catalogue,
                                     const std::vector<matlab::Table>& tables,
                                     const std::vector<std::vector<std::vector<double>>>& values,
                                     bool is_timed,
                                     std::vector<Note>& notes) {
  const Labeller labeller(catalogue, tables);
  std::vector<std::string> headings;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const bool may_have_time = tables[i].width != 1 && tables[i].width != 3;
    const bool has_time =
        !is_timed && may_have_time && !labeller.has_columns(tables[i]) && ascends(values[i][0]);
    is_timed = is_timed || has_time;
    for (std::string& heading : labeller.headings(tables[i], i, has_time, notes))
      headings.push_back(std::move(heading));
  }
  return headings;
}

std::optional<std::int64_t> start_ns_of(const Catalogue& catalogue, std::string_view path) {
  for (;; path = group_of(path)) {
    for (const Attribute& attribute : catalogue.attributes)
      if (attribute.owner == path && attribute.name == "start_time_ns" && attribute.integer)
        return attribute.integer;
    if (path.empty()) return std::nullopt;
  }
}

}  // namespace proofmass::io::hdf5
