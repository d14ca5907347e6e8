#include "proofmass/io/csv/columns.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

bool is_calendar(ColumnKind kind) {
  return kind == ColumnKind::clock || kind == ColumnKind::time_of_day;
}

bool can_be_time(ColumnKind kind) {
  return kind == ColumnKind::number || kind == ColumnKind::blank || is_calendar(kind);
}

std::string names_of(const CsvHeader& header) {
  std::string names;
  for (std::size_t c = 0; c < std::min<std::size_t>(header.labels.size(), 12); ++c)
    names += (c == 0 ? "" : ", ") + header.labels[c].name;
  return names + (header.labels.size() > 12 ? ", …" : "");
}

Result<std::size_t> named_time(const CsvLayout& layout,
                               const CsvHeader& header,
                               const std::string& name) {
  const auto matches = [&](const ColumnLabel& label) {
    return label.name == name || lower(label.name) == lower(name) ||
           lower(read_label(name).name) == lower(label.name);
  };
  const auto at = std::ranges::find_if(header.labels, matches);
  if (at == header.labels.end())
    return Error{Errc::invalid_argument,
                 fmt::format("has no column {} for the time; it has {}", name, names_of(header))};
  const auto column = static_cast<std::size_t>(at - header.labels.begin());
  if (!can_be_time(layout.columns[column]))
    return Error{Errc::invalid_argument,
                 fmt::format("column {} is not a time: it holds words or dates alone", name)};
  return column;
}

std::optional<std::size_t> likely_time(const CsvLayout& layout, const CsvHeader& header) {
  std::optional<std::size_t> best;
  int best_likeness = 0;
  for (std::size_t c = 0; c < header.labels.size(); ++c) {
    if (!can_be_time(layout.columns[c])) continue;
    int likeness = header.found ? likeness_to_time(header.labels[c]) : 0;
    if (likeness == 0 && is_calendar(layout.columns[c])) likeness = 1;
    if (!header.found && c == 0 && layout.first_ascends && layout.columns.size() > 1) likeness = 1;
    if (likeness <= best_likeness) continue;
    best = c;
    best_likeness = likeness;
  }
  return best;
}

std::vector<ColumnUse> usual_uses(const CsvLayout& layout) {
  constexpr std::size_t most_words = 4;
  std::size_t words = 0;
  std::vector<ColumnUse> uses;
  for (const ColumnKind kind : layout.columns) {
    if (kind == ColumnKind::number || kind == ColumnKind::blank)
      uses.push_back(ColumnUse::keep);
    else
      uses.push_back(kind == ColumnKind::text && words++ < most_words ? ColumnUse::words
                                                                      : ColumnUse::skip);
  }
  return uses;
}

}  // namespace

Result<CsvColumns> choose_columns(const CsvLayout& layout,
                                  const CsvHeader& header,
                                  const ReadOptions& options) {
  CsvColumns columns;
  if (options.time_channel.empty()) {
    columns.stamps = likely_time(layout, header);
  } else {
    const auto named = named_time(layout, header, options.time_channel);
    if (!named) return named.error();
    columns.stamps = *named;
  }
  columns.uses = usual_uses(layout);
  if (!columns.stamps) return columns;
  columns.uses[*columns.stamps] = ColumnUse::stamps;
  const ColumnKind kind = layout.columns[*columns.stamps];
  if (is_calendar(kind)) columns.spelling = StampSpelling::clock;
  const auto date = std::ranges::find(layout.columns, ColumnKind::date);
  if (kind == ColumnKind::time_of_day && date != layout.columns.end()) {
    columns.spelling = StampSpelling::date_then_clock;
    columns.date = static_cast<std::size_t>(date - layout.columns.begin());
  }
  return columns;
}

}  // namespace proofmass::io
