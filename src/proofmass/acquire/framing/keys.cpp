#include "proofmass/acquire/framing/keys.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "proofmass/acquire/framing/dialect.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/json_leaves.hpp"

namespace proofmass::acquire {
namespace {

struct Pair {
  std::string_view label, figure;
};

bool is_label(std::string_view text) {
  constexpr std::size_t longest = 64;
  if (text.empty() || text.size() > longest) return false;
  const char first = text.front();
  const bool is_letter = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z');
  return is_letter || first == '_' || static_cast<unsigned char>(first) >= 0x80;
}

/// Removes "label:value" from the front; false if the text does not begin with one.
bool take_pair(std::string_view& rest, char separator, Pair& pair) {
  const std::size_t mark = rest.find_first_of(":=");
  if (mark == std::string_view::npos) return false;
  pair.label = io::trimmed(rest.substr(0, mark));
  rest.remove_prefix(mark + 1);
  // A blank may follow the separator, whatever separates the pairs.
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  pair.figure = io::trimmed(rest.substr(0, rest.find(separator)));
  rest.remove_prefix(std::min(rest.find(separator), rest.size()));
  rest.remove_prefix(
      std::min(rest.find_first_not_of(std::string_view(&separator, 1)), rest.size()));
  return is_label(pair.label);
}

/// The decimal mark: a comma that separates pairs cannot occur in a value.
char point_of(std::string_view figure) {
  return figure.find('.') == std::string_view::npos ? ',' : '.';
}

bool split_pairs(std::string_view line, char separator, std::vector<Pair>& pairs) {
  pairs.clear();
  std::string_view rest = line;
  while (!rest.empty()) {
    Pair pair;
    if (!take_pair(rest, separator, pair)) return false;
    if (io::read_cell(pair.figure, point_of(pair.figure)).kind == io::CellKind::text) return false;
    pairs.push_back(pair);
  }
  return !pairs.empty();
}

bool visit_pairs(std::string_view line, const KeyVisit& visit) {
  std::vector<Pair> pairs;
  line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
  for (const char separator : {';', '\t', ',', ' '}) {
    if (!split_pairs(line, separator, pairs)) continue;
    for (const auto& [label, figure] : pairs) {
      const char point = point_of(figure);
      visit(label, io::read_cell(figure, point).value, tick_in(figure, point));
    }
    return true;
  }
  return false;
}

bool visit_object(std::string_view document, const KeyVisit& visit) {
  const auto visited = io::visit_json(document, [&](const io::JsonLeaf& leaf) {
    if (leaf.text) {
      const io::Cell cell = io::read_cell(*leaf.text, '.');
      visit(leaf.path, cell.value, tick_in(io::trimmed(*leaf.text), '.'));
    } else {
      visit(leaf.path, leaf.figure,
            leaf.whole ? std::optional(Tick{*leaf.whole, 0}) : tick_of(leaf.figure));
    }
  });
  return visited.has_value();
}

}  // namespace

bool visit_keys(std::string_view line, const KeyVisit& visit) {
  if (is_osc(line)) return visit_osc(line, visit);
  const std::size_t first = line.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  if (line[first] == '{' || line[first] == '[') return visit_object(line, visit);
  return visit_pairs(line, visit);
}

}  // namespace proofmass::acquire
