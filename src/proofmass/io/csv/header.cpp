#include "proofmass/io/csv/header.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <set>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/csv/start.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io {
namespace {

using Fields = std::vector<std::string>;

Fields fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> views;
  split_fields(line, separator, views);
  Fields fields;
  for (const std::string_view view : views) fields.emplace_back(without_guard(trimmed(view)));
  while (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

/// "degrees C" and similar, which contain a blank.
std::optional<Unit> unit_in(std::string_view text) {
  text = trimmed(text);
  for (const std::string_view degrees : {"degrees ", "degree ", "deg ", "° "})
    if (text.starts_with(degrees) && text.size() == degrees.size() + 1)
      return parse_unit("deg" + std::string(text.substr(degrees.size())));
  return parse_unit(text);
}

/// A unit at the end of a name, where the separator before it may be part of the name too: short
/// ones only if they are common.
std::optional<Unit> unit_of_suffix(std::string_view suffix) {
  constexpr std::array<std::string_view, 4> parts_of_names{"min", "count", "raw", "counts"};
  if (std::ranges::find(parts_of_names, suffix) != parts_of_names.end()) return std::nullopt;
  if (suffix.size() == 1 && suffix != "g" && suffix != "s" && suffix != "V") return std::nullopt;
  return unit_in(suffix);
}

std::string without(std::string_view text, std::size_t begin, std::size_t end) {
  const std::string_view before = trimmed(text.substr(0, begin));
  const std::string_view after = trimmed(text.substr(end));
  return std::string(before) + (before.empty() || after.empty() ? "" : " ") + std::string(after);
}

/// A heading whose last brackets of a kind contain a unit; nested brackets belong to the unit:
/// "(m/(s^2))".
std::optional<ColumnLabel> label_with_bracket(std::string_view text,
                                              std::size_t open,
                                              char closing) {
  for (const std::size_t close : {text.find(closing, open), text.rfind(closing)}) {
    if (close == std::string_view::npos || close < open) continue;
    if (const auto unit = unit_in(text.substr(open + 1, close - open - 1)))
      return ColumnLabel{without(text, open, close + 1), *unit};
  }
  return std::nullopt;
}

std::optional<ColumnLabel> label_with_brackets(std::string_view text) {
  constexpr std::string_view opening = "([{";
  constexpr std::string_view closing = ")]}";
  for (std::size_t i = text.size(); i-- > 0;) {
    const std::size_t kind = opening.find(text[i]);
    if (kind == std::string_view::npos) continue;
    if (const auto label = label_with_bracket(text, i, closing[kind])) return label;
  }
  return std::nullopt;
}

/// "acc_x_m_s2" and "gyr_x_deg_s": the slash of a quotient is not allowed in every name.
std::optional<ColumnLabel> label_with_quotient(std::string_view text) {
  const std::size_t last = text.rfind('_');
  if (last == std::string_view::npos || last == 0) return std::nullopt;
  const std::size_t before = text.rfind('_', last - 1);
  if (before == std::string_view::npos || before == 0) return std::nullopt;
  std::string unit_text(text.substr(before + 1));
  unit_text[last - before - 1] = '/';
  const auto unit = parse_unit(unit_text);
  if (!unit) return std::nullopt;
  return ColumnLabel{std::string(text.substr(0, before)), *unit};
}

bool is_unit_or_nothing(const std::string& field) {
  return field.empty() || field == "-" || field == "1" || field == "n/a" || unit_in(field);
}

bool is_unit_row(const Fields& fields) {
  return std::ranges::all_of(fields, is_unit_or_nothing) &&
         std::ranges::any_of(fields, [](const std::string& f) { return unit_in(f).has_value(); });
}

/// "time (s)x (g)" is two headings without the separator between them.
Fields split_behind_brackets(const Fields& fields) {
  Fields out;
  for (const std::string& field : fields) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i + 1 < field.size(); ++i) {
      if (field[i] != ')' && field[i] != ']') continue;
      const std::string rest(trimmed(std::string_view(field).substr(i + 1)));
      if (rest.empty() || !label_with_brackets(rest)) continue;
      out.push_back(field.substr(begin, i + 1 - begin));
      begin = i + 1;
    }
    out.emplace_back(trimmed(std::string_view(field).substr(begin)));
  }
  return out;
}

bool has_text(const Fields& fields, char point) {
  return std::ranges::any_of(
      fields, [&](const std::string& f) { return read_cell(f, point).kind == CellKind::text; });
}

/// The lines above the rows, split into fields, as a header; nearest line first.
class HeaderFinder {
 public:
  explicit HeaderFinder(const CsvLayout& layout) : layout_(layout) {}

  CsvHeader find() {
    std::vector<const PreambleLine*> plain;
    for (auto line = layout_.preamble.rbegin(); line != layout_.preamble.rend(); ++line)
      if (!line->is_comment) plain.push_back(&*line);
    if (!plain.empty()) use_plain(plain);
    if (!header_.found) use_remark();
    if (!header_.found) make_up_names();
    complete_names(header_.labels, header_.notes);
    return std::move(header_);
  }

 private:
  [[nodiscard]] std::size_t width() const { return layout_.columns.size(); }

  /// The line's fields, adjusted to the number of columns if possible.
  Fields fitted(const std::string& text) {
    Fields fields = fields_of(text, layout_.separator);
    if (fields.size() == width()) return fields;
    if (Fields split = split_behind_brackets(fields); split.size() == width()) {
      header_.notes.push_back({Severity::info, "a separator is missing in the header: added"});
      return split;
    }
    for (const char separator : {',', ';', '\t', '|', ' '})
      if (Fields other = fields_of(text, separator); other.size() == width()) return other;
    return fields;
  }

  void use_plain(const std::vector<const PreambleLine*>& lines) {
    std::size_t at = 0;
    Fields units;
    if (lines.size() > 1) {
      Fields lowest = fields_of(lines[0]->text, layout_.separator);
      if (lowest.size() <= width() && is_unit_row(lowest)) {
        units = std::move(lowest);
        at = 1;
      }
    }
    const Fields names = fitted(lines[at]->text);
    const bool wide_enough = names.size() * 2 > width() || names.size() == width();
    if (!wide_enough || !has_text(names, layout_.point)) return;
    header_.found = true;
    header_.line = lines[0]->number;
    take(with_groups(names, lines, at + 1), units);
  }

  /// "IMU Acceleration;;;" above "X;Y;Z" is "IMU Acceleration X", …
  Fields with_groups(const Fields& names,
                     const std::vector<const PreambleLine*>& lines,
                     std::size_t above) {
    if (above >= lines.size() || lines[above]->number + 1 != lines[above - 1]->number) return names;
    const Fields groups = fields_of(lines[above]->text, layout_.separator);
    const auto empty = std::ranges::count(groups, std::string{});
    const std::set<std::string> distinct(names.begin(), names.end());
    const bool repeats = distinct.size() < names.size() || names.front().empty();
    if (groups.size() < 2 || empty == 0 || !repeats) return names;
    Fields joined;
    std::string group;
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (c < groups.size() && !groups[c].empty()) group = groups[c];
      joined.push_back(group + (group.empty() || names[c].empty() ? "" : " ") + names[c]);
    }
    return joined;
  }

  /// "# t, ax, ay, az" or GCDC's ";Headers, time,Ax,Ay,Az".
  void use_remark() {
    if (width() < 2) return;
    for (auto line = layout_.preamble.rbegin(); line != layout_.preamble.rend(); ++line) {
      if (!line->is_comment) return;
      Fields fields = fields_of(line->text, layout_.separator);
      if (fields.size() == width() + 1 && lower(fields[0]).starts_with("header"))
        fields.erase(fields.begin());
      const bool all_text = std::ranges::all_of(fields, [&](const std::string& field) {
        return read_cell(field, layout_.point).kind == CellKind::text;
      });
      if (fields.size() != width() || !all_text) continue;
      header_.found = true;
      header_.line = line->number;
      take(fields, {});
      return;
    }
  }

  void take(const Fields& names, const Fields& units) {
    if (names.size() != width())
      header_.notes.push_back(
          {Severity::warning,
           fmt::format("the header on line {} names {} columns, the rows have {}", header_.line,
                       names.size(), width())});
    for (std::size_t c = 0; c < width(); ++c) {
      ColumnLabel label = c < names.size() ? read_label(names[c]) : ColumnLabel{};
      if (c < units.size())
        if (const auto unit = unit_in(units[c])) label.unit = *unit;
      header_.labels.push_back(std::move(label));
    }
    if (!units.empty())
      header_.notes.push_back({Severity::info, "a row of units below the header"});
  }

  void make_up_names() {
    const bool timed = layout_.first_ascends && width() > 1;
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    for (std::size_t c = 0; c < width(); ++c) {
      std::string name = fmt::format("column {}", c + 1);
      if (width() == 3 + (timed ? 1u : 0u) && c >= (timed ? 1u : 0u))
        name = axes[c - (timed ? 1 : 0)];
      if (timed && c == 0) name = "time";
      header_.labels.push_back({std::move(name), {}});
    }
    header_.notes.push_back({Severity::info, "no header: columns named by their place"});
  }

  const CsvLayout& layout_;
  CsvHeader header_;
};

/// The first number after "sample rate", "SampleRate", "update rate", "sampling frequency", …
std::optional<double> rate_in(const std::string& line) {
  const std::string text = lower(line);
  std::size_t at = std::string::npos;
  for (const std::string_view word : {"rate", "freq"})
    if (at == std::string::npos) at = text.find(word);
  if (at == std::string::npos) return std::nullopt;
  constexpr std::array<std::string_view, 4> kinds{"sampl", "update", "data", "output"};
  if (std::ranges::none_of(kinds, [&](auto kind) { return text.find(kind) < at; }))
    return std::nullopt;
  const std::size_t first = text.find_first_of("0123456789", at);
  if (first == std::string::npos) return std::nullopt;
  const std::size_t last = std::min(text.find_first_not_of("0123456789.e", first), text.size());
  const Cell cell = read_cell(std::string_view(text).substr(first, last - first), '.');
  const double rate_hz = cell.value * (text.find("khz", last) != std::string::npos ? 1e3 : 1.0);
  const bool is_rate = cell.kind == CellKind::number && rate_hz > 0.01 && rate_hz < 1e7;
  if (!is_rate) return std::nullopt;
  return rate_hz;
}

}  // namespace

ColumnLabel read_label(std::string_view heading) {
  const std::string_view text = trimmed(heading);
  if (const auto label = label_with_brackets(text)) return *label;
  if (const auto label = label_with_quotient(text)) return *label;
  for (const char mark : {',', '_', ' '}) {
    const std::size_t at = text.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    if (const auto unit = unit_of_suffix(trimmed(text.substr(at + 1))))
      return {std::string(trimmed(text.substr(0, at))), *unit};
  }
  return {std::string(text), {}};
}

int likeness_to_time(const ColumnLabel& label) {
  // "T (degC)" is a temperature; ticks may be called counts.
  const Quantity quantity = label.unit.quantity;
  if (quantity != Quantity::time && quantity != Quantity::unknown && quantity != Quantity::counts)
    return 0;
  const std::string bare = bare_name(label.name);
  constexpr std::array<std::string_view, 11> certain{
      "time",           "timestamp", "t",     "sampletimefine", "timestamps", "elapsedtime",
      "secondselapsed", "datetime",  "times", "timeelapsed",    "zeit"};
  constexpr std::array<std::string_view, 12> likely{"sec",   "secs",   "seconds", "elapsed",
                                                    "epoch", "millis", "micros",  "clock",
                                                    "utc",   "ms",     "us",      "date"};
  if (std::ranges::find(certain, std::string_view(bare)) != certain.end()) return 4;
  if (bare.starts_with("timestamp") || bare.ends_with("timestamp")) return 3;
  if (std::ranges::find(likely, std::string_view(bare)) != likely.end()) return 3;
  if (bare.starts_with("time") || bare.ends_with("time")) return 2;
  return label.unit.quantity == Quantity::time ? 1 : 0;
}

void complete_names(std::vector<ColumnLabel>& labels, std::vector<Note>& notes) {
  std::set<std::string> taken;
  std::map<std::string, int> next;  // number for the next column with a name in use
  std::size_t renamed = 0;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::string wanted =
        labels[c].name.empty() ? fmt::format("column {}", c + 1) : labels[c].name;
    std::string name = wanted;
    for (int& n = next.try_emplace(wanted, 2).first->second; !taken.insert(name).second; ++n)
      name = fmt::format("{} {}", wanted, n);
    constexpr std::size_t most_notes = 8;
    if (name != wanted && ++renamed <= most_notes)
      notes.push_back(
          {Severity::warning,
           fmt::format("two columns are called {}: the later is {} here", wanted, name)});
    labels[c].name = name;
  }
}

CsvHeader read_header(const CsvLayout& layout) {
  CsvHeader header = HeaderFinder(layout).find();
  for (ColumnLabel& label : header.labels) label.name = clean_text(label.name);
  for (const PreambleLine& line : layout.preamble)
    if (!header.rate_hz && line.number != header.line) header.rate_hz = rate_in(line.text);
  CsvStart start = read_csv_start(layout);
  header.zero_ns = start.zero_ns;
  std::ranges::move(start.notes, std::back_inserter(header.notes));
  return header;
}

std::optional<std::string> contradiction(const CsvHeader& header,
                                         const CsvLayout& layout,
                                         const PreambleLine& line) {
  if (!header.found) return std::nullopt;
  const Fields fields = fields_of(line.text, layout.separator);
  const bool is_units = is_unit_row(fields);
  std::vector<ColumnLabel> labels;
  for (const std::string& field : fields)
    labels.push_back(is_units ? ColumnLabel{{}, unit_in(field).value_or(Unit{})}
                              : read_label(field));
  const auto place = [&](const std::string& name) {
    const auto at = std::ranges::find_if(
        header.labels, [&](const ColumnLabel& label) { return lower(label.name) == lower(name); });
    return static_cast<std::size_t>(at - header.labels.begin());
  };
  const std::size_t width = std::min(labels.size(), header.labels.size());
  std::size_t known = 0;
  std::optional<std::string> why;
  for (std::size_t c = 0; c < width; ++c) {
    const std::size_t at = is_units ? c : place(labels[c].name);
    if (at == header.labels.size()) continue;
    ++known;
    const ColumnLabel& first = header.labels[at];
    const bool have_units =
        labels[c].unit.quantity != Quantity::unknown && first.unit.quantity != Quantity::unknown;
    if (!why && at != c)
      why = fmt::format("{} is column {} from here on, not {}", first.name, c + 1, at + 1);
    if (!why && have_units && labels[c].unit != first.unit)
      why = fmt::format("{} is in {} from here on, not in {}", first.name, labels[c].unit.symbol,
                        first.unit.symbol);
  }
  if (!why || known * 2 < width) return std::nullopt;
  return fmt::format("line {}: a second header, by which {}: split the file there", line.number,
                     *why);
}

}  // namespace proofmass::io
