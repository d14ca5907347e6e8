#include "proofmass/io/positions/instant_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/units.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/positions/interval_columns.hpp"
#include "proofmass/io/positions/text_lines.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

constexpr auto time_names = std::to_array<std::string_view>(
    {"time", "times", "t", "timestamp", "instant", "at", "turn", "turns"});
constexpr auto position_names = std::to_array<std::string_view>(
    {"position", "pos", "p", "x", "displacement", "distance", "height", "length"});
constexpr auto std_names =
    std::to_array<std::string_view>({"std", "sd", "sigma", "stddev", "stdev", "uncertainty",
                                     "standarddeviation", "positionstd", "posstd", "stdposition"});

/// A column and the conversion of its values to SI.
struct Figures {
  std::size_t column = 0;
  double to_si = 1.0;
};

struct InstantColumns {
  char separator = ',';
  char point = '.';
  bool has_header = false;
  std::optional<Figures> time, position, std;
};

InstantColumns bare_columns(char separator, std::size_t fields) {
  InstantColumns columns{.separator = separator, .time = {}, .position = {}, .std = {}};
  columns.time = Figures{};
  if (fields > 1) columns.position = Figures{1, 1.0};
  if (fields > 2) columns.std = Figures{2, 1.0};
  return columns;
}

/// The first column of its kind, unless the heading has the unit of another quantity.
bool enter(const ColumnLabel& label,
           std::size_t column,
           Quantity quantity,
           std::optional<Figures>& into) {
  const bool has_unit = label.unit.quantity != Quantity::unknown;
  if (into || (has_unit && label.unit.quantity != quantity)) return false;
  into = Figures{column, has_unit ? label.unit.to_si : 1.0};
  return true;
}

/// nullopt if a heading has an invalid unit.
std::optional<InstantColumns> named_columns(char separator,
                                            const std::vector<std::string>& fields) {
  InstantColumns columns{
      .separator = separator, .has_header = true, .time = {}, .position = {}, .std = {}};
  bool std_has_unit = false;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const ColumnLabel label = read_label(fields[c]);
    if (is_one_of(label.name, time_names)) enter(label, c, Quantity::time, columns.time);
    if (is_one_of(label.name, position_names)) enter(label, c, Quantity::length, columns.position);
    if (is_one_of(label.name, std_names) && enter(label, c, Quantity::length, columns.std))
      std_has_unit = label.unit.quantity != Quantity::unknown;
  }
  if (!columns.time) return std::nullopt;
  if (columns.std && !std_has_unit && columns.position)
    columns.std->to_si = columns.position->to_si;
  return columns;
}

/// A comma within a number is the decimal mark if it is not the separator.
char decimal_mark_of(const std::vector<TextLine>& lines, char separator) {
  if (separator == ',') return '.';
  for (const TextLine& line : lines)
    for (const std::string& field : fields_of(line, separator))
      if (field.find(',') != std::string::npos && is_figure(field)) return ',';
  return '.';
}

/// The possible separators of a line; 0 if it is a single field, including blanks.
std::vector<char> separators_of(const std::string& line) {
  for (const char separator : {'\t', ';', ',', '|'})
    if (line.find(separator) != std::string::npos) return {separator};
  return {'\0', ' '};
}

Result<InstantColumns> find_columns(const std::vector<TextLine>& lines) {
  const TextLine& first = lines.front();
  for (const char separator : separators_of(first.text)) {
    const auto fields = fields_of(first, separator);
    std::optional<InstantColumns> columns = named_columns(separator, fields);
    if (!columns && std::ranges::all_of(fields, is_figure))
      columns = bare_columns(separator, fields.size());
    if (!columns) continue;
    columns->point = decimal_mark_of(lines, separator);
    return *columns;
  }
  return Error{Errc::corrupt, fmt::format("line {}: expected a header with time (and position, "
                                          "std), or rows of figures",
                                          first.number)};
}

Result<Instant> instant_of(const TextLine& line, const InstantColumns& columns) {
  const auto fields = fields_of(line, columns.separator);
  const auto wrong = [&](std::string_view what) {
    return Error{Errc::corrupt, fmt::format("line {}: {}", line.number, what)};
  };
  const auto figure = [&](const Figures& of) {
    const double value = of.column < fields.size()
                             ? read_cell(fields[of.column], columns.point).value
                             : std::nan("");
    return value * of.to_si;
  };
  Instant instant{.time_s = figure(*columns.time), .position_m = {}, .std_m = {}, .line = 0};
  instant.line = line.number;
  if (!std::isfinite(instant.time_s)) return wrong("the time is not a number");
  if (columns.position) instant.position_m = figure(*columns.position);
  if (columns.std) instant.std_m = figure(*columns.std);
  if (instant.position_m && !std::isfinite(*instant.position_m))
    return wrong("the position is not a number");
  if (instant.std_m && !(std::isfinite(*instant.std_m) && *instant.std_m > 0.0))
    return wrong("the standard deviation is not a number above 0");
  return instant;
}

Result<std::vector<Instant>> instants_in(const std::vector<TextLine>& lines) {
  const auto columns = find_columns(lines);
  if (!columns) return columns.error();
  std::vector<Instant> instants;
  for (std::size_t i = columns->has_header ? 1 : 0; i < lines.size(); ++i) {
    auto instant = instant_of(lines[i], *columns);
    if (!instant) return instant.error();
    instants.push_back(*instant);
  }
  if (instants.empty()) return Error{Errc::too_few_samples, "has no row"};
  std::ranges::stable_sort(instants, {}, &Instant::time_s);
  for (std::size_t i = 1; i < instants.size(); ++i)
    if (instants[i].time_s == instants[i - 1].time_s)
      return Error{Errc::corrupt, fmt::format("line {}: the same time as in line {}",
                                              instants[i].line, instants[i - 1].line)};
  return instants;
}

Result<std::vector<Instant>> instants_of(const Result<std::vector<TextLine>>& lines,
                                         const std::string& name) {
  const std::string where = name == "-" ? "standard input" : name;
  if (!lines) return lines.error().at(where);
  auto instants = instants_in(*lines);
  if (!instants) return instants.error().at(where);
  return instants;
}

bool is_inside(const Instant& instant, double duration_s) {
  return instant.time_s >= 0.0 && instant.time_s <= duration_s;
}

}  // namespace

Result<std::vector<Instant>> read_instants(const std::string& path) {
  return instants_of(read_lines(path), path);
}

Result<std::vector<Instant>> read_instants(std::span<const std::byte> bytes,
                                           const std::string& name) {
  return instants_of(read_lines(bytes), name);
}

Status check_inside(const std::vector<Instant>& instants, double duration_s) {
  for (const Instant& instant : instants) {
    if (is_inside(instant, duration_s)) continue;
    return Error{Errc::invalid_argument,
                 fmt::format("line {}: {} s is outside the recording, which has 0 s to {} s: times "
                             "count from its first sample",
                             instant.line, in_words(instant.time_s), in_words(duration_s))};
  }
  return Done{};
}

std::size_t drop_outside(std::vector<Instant>& instants, double duration_s) {
  return std::erase_if(instants,
                       [&](const Instant& instant) { return !is_inside(instant, duration_s); });
}

}  // namespace proofmass::io
