#include "proofmass/io/positions/interval_columns.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::io {
namespace {

std::string without(std::string text, std::string_view word) {
  if (const auto at = text.find(word); at != std::string::npos) text.erase(at, word.size());
  return text;
}

/// The headings of a line by role.
struct Headings {
  std::optional<IntervalEdge> start, end;
  std::optional<std::size_t> label;
  std::array<std::optional<std::size_t>, 3> up;
  std::optional<std::size_t> angle;
  double angle_unit_rad = rad_per_deg;
};

/// A heading that may be an end of the interval: "start (s)", "t_end", "first", "end sample",
/// "Start time [ms]".
void enter_edge(Headings& headings, std::size_t c, const ColumnLabel& label) {
  const std::string bare = bare_name(label.name);
  std::string name = bare;
  for (const std::string_view word : {"samples", "sample", "index", "time"})
    name = without(name, word);
  const bool begins = is_any_of(name, {"start", "begin", "from", "tstart", "first"});
  if (!begins && !is_any_of(name, {"end", "stop", "to", "tend", "last"})) return;
  auto& edge = begins ? headings.start : headings.end;
  if (edge) return;
  edge = IntervalEdge{.column = c};
  if (label.unit.quantity == Quantity::time) {
    edge->counts = Counts::seconds;
    edge->unit_s = label.unit.to_si;
  } else if (is_any_of(name, {"first", "last"}) || bare.find("sample") != std::string::npos ||
             bare.find("index") != std::string::npos) {
    edge->counts = Counts::samples;
  }
}

/// "up_x", "x_true", "true x"; the axis, 0 to 2.
std::optional<std::size_t> axis_of_direction(const std::string& bare) {
  for (const std::string word : {"up", "true", "ref", "direction", "dir"}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const char letter = static_cast<char>('x' + axis);
      if (bare == word + letter || bare == letter + word) return axis;
    }
  }
  return std::nullopt;
}

bool is_label(const std::string& bare) {
  return is_any_of(bare, {"label", "labels", "name", "text", "part", "position", "pose",
                          "orientation", "annotation", "description", "activity"});
}

Headings headings_of(const std::vector<std::string>& fields) {
  Headings headings;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const ColumnLabel label = read_label(fields[c]);
    const std::string bare = bare_name(label.name);
    enter_edge(headings, c, label);
    if (is_label(bare) && !headings.label) headings.label = c;
    if (bare == "angle" && !headings.angle) {
      headings.angle = c;
      if (label.unit.quantity == Quantity::angle) headings.angle_unit_rad = label.unit.to_si;
    }
    if (const auto axis = axis_of_direction(bare); axis && !headings.up[*axis])
      headings.up[*axis] = c;
  }
  return headings;
}

Result<IntervalColumns> columns_under(const Headings& headings, char separator) {
  IntervalColumns columns;
  columns.separator = separator;
  columns.has_header = true;
  columns.start = *headings.start;
  columns.end = *headings.end;
  columns.label = headings.label;
  columns.angle = headings.angle;
  columns.angle_unit_rad = headings.angle_unit_rad;
  const auto is_in_seconds = [](const IntervalEdge& e) { return e.counts == Counts::seconds; };
  if (columns.in_samples() && (is_in_seconds(columns.start) || is_in_seconds(columns.end)))
    return Error{Errc::corrupt, "one of start and end is in seconds, the other in samples"};
  const auto axes = std::ranges::count_if(headings.up, [](const auto& c) { return c.has_value(); });
  if (axes == 1 || axes == 2) return Error{Errc::corrupt, "a direction needs all of x, y and z"};
  if (axes == 3) columns.up = {*headings.up[0], *headings.up[1], *headings.up[2]};
  return columns;
}

/// A comma within a number is the decimal mark if it is not the separator.
char decimal_mark(const std::vector<TextLine>& lines, const IntervalColumns& columns) {
  if (columns.separator == ',') return '.';
  for (const TextLine& line : lines) {
    const auto fields = fields_of(line, columns.separator);
    for (const std::size_t c : {columns.start.column, columns.end.column})
      if (c < fields.size() && is_figure(fields[c]) && fields[c].find(',') != std::string::npos)
        return ',';
  }
  return '.';
}

}  // namespace

bool is_figure(const std::string& field) {
  return read_cell(field, '.').kind == CellKind::number ||
         read_cell(field, ',').kind == CellKind::number;
}

std::vector<std::string> fields_of(const TextLine& line, char separator) {
  std::vector<std::string_view> views;
  split_fields(line.text, separator, views);
  std::vector<std::string> fields;
  fields.reserve(views.size());
  for (const std::string_view view : views) fields.emplace_back(trimmed(view));
  return fields;
}

Result<IntervalColumns> find_interval_columns(const std::vector<TextLine>& lines) {
  const TextLine& first = lines.front();
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    const auto fields = fields_of(first, separator);
    if (fields.size() < 2) continue;
    IntervalColumns columns;
    if (is_figure(fields[0]) && is_figure(fields[1])) {
      columns.separator = separator;
      columns.end.column = 1;
      columns.label = 2;
    } else if (const Headings headings = headings_of(fields); headings.start && headings.end) {
      const auto named = columns_under(headings, separator);
      if (!named) return named.error().at(fmt::format("line {}", first.number));
      columns = *named;
    } else {
      continue;
    }
    columns.point = decimal_mark(lines, columns);
    return columns;
  }
  return Error{Errc::corrupt,
               fmt::format("line {}: expected a header with start and end (or first and last), or "
                           "rows of start, end and text",
                           first.number)};
}

}  // namespace proofmass::io
