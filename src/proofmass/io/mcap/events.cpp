#include "proofmass/io/mcap/events.hpp"

#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/json_leaves.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::mcap {

void Events::add(const Message& message) {
  std::string kind, text;
  double rows = 0.0, time_s = 0.0;
  const Status visited = visit_json(message.data, [&](const JsonLeaf& leaf) {
    if (leaf.path == "kind" && leaf.text) kind = shown(*leaf.text);
    if (leaf.path == "text" && leaf.text) text = shown(*leaf.text);
    if (leaf.path == "rows" && leaf.figure > 0.0) rows = leaf.figure;
    if (leaf.path == "time_s") time_s = leaf.figure;
  });
  constexpr std::size_t most_kinds = 32;
  if (!visited || kind.empty() || (kinds_.size() == most_kinds && !kinds_.contains(kind))) return;
  if (kinds_.empty()) first_ = fmt::format("{:.6g} s: {}", time_s, text);
  Kind& known = kinds_[kind];
  ++known.events;
  known.rows += rows;
}

std::optional<Note> Events::note() const {
  if (kinds_.empty()) return std::nullopt;
  std::string words;
  for (const auto& [name, kind] : kinds_) {
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", kind.events, name);
    if (kind.rows > 0.0) words += fmt::format(" ({:.0f} rows)", kind.rows);
  }
  return Note{Severity::info,
              fmt::format("events while it was recorded: {}; the first at {}", words, first_)};
}

}  // namespace proofmass::io::mcap
