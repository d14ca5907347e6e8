#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/acquire/framing/dialect.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/csv/layout.hpp"

namespace proofmass::acquire {
namespace {

using io::CellKind;
using io::ColumnKind;

/// A date with a time of day, or a time of day, in seconds.
std::optional<Tick> tick_of_calendar(std::string_view text) {
  const auto reading = io::read_clock(io::trimmed(text));
  if (!reading || !reading->ns) return std::nullopt;
  const auto ns = reading->days ? io::instant_ns(*reading) : reading->ns;
  if (!ns) return std::nullopt;
  const std::int64_t fraction = (*ns % ns_per_s + ns_per_s) % ns_per_s;
  return Tick{(*ns - fraction) / ns_per_s, static_cast<std::int32_t>(fraction)};
}

class Table final : public LineDialect {
 public:
  Table(io::CsvLayout layout, std::vector<RowField> fields, bool has_names, std::string header)
      : layout_(std::move(layout)),
        fields_(std::move(fields)),
        has_names_(has_names),
        header_(std::move(header)) {}

  const std::vector<RowField>& fields() const override { return fields_; }
  bool has_names() const override { return has_names_; }

  LineFit read(std::string_view line,
               std::optional<std::size_t> clock,
               std::span<double> values,
               std::optional<Tick>& tick) override {
    if (!header_.empty() && io::trimmed(line) == header_) return LineFit::header;
    if (io::is_remark(line, layout_.separator)) return LineFit::words;
    io::split_fields(line, layout_.separator, cells_);
    if (cells_.size() == fields_.size() + 1 && io::trimmed(cells_.back()).empty())
      cells_.pop_back();
    if (cells_.size() != fields_.size()) return misfit();
    const LineFit fit = read_figures(values);
    if (fit == LineFit::row && clock)
      tick = fields_[*clock].is_calendar ? tick_of_calendar(cells_[*clock])
                                         : tick_in(io::trimmed(cells_[*clock]), layout_.point);
    return fit;
  }

 private:
  LineFit read_figures(std::span<double> values) const {
    bool has_figure = false;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (!fields_[c].is_figures) continue;
      const io::Cell cell = io::read_cell(cells_[c], layout_.point);
      if (cell.kind == CellKind::text) return misfit();
      has_figure = has_figure || cell.kind == CellKind::number;
      values[c] = cell.value;
    }
    return has_figure ? LineFit::row : LineFit::words;
  }

  /// A line with numbers for half of the columns was a row.
  [[nodiscard]] LineFit misfit() const {
    const auto figures = std::ranges::count_if(cells_, [&](std::string_view cell) {
      return io::read_cell(cell, layout_.point).kind == CellKind::number;
    });
    return 2 * static_cast<std::size_t>(figures) >= fields_.size() ? LineFit::broken
                                                                   : LineFit::words;
  }

  io::CsvLayout layout_;
  std::vector<RowField> fields_;
  bool has_names_;
  std::string header_;
  std::vector<std::string_view> cells_;
};

std::string joined(std::span<const HeldLine> lines) {
  std::string text;
  for (const HeldLine& line : lines) {
    // A document in a datagram may have several lines, which would invalidate the count.
    const auto first = static_cast<std::ptrdiff_t>(text.size());
    text += line.text;
    std::replace(text.begin() + first, text.end(), '\n', ' ');
    text += '\n';
  }
  return text;
}

bool is_words_only(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  io::split_fields(line, separator, cells);
  return std::ranges::all_of(
      cells, [](std::string_view cell) { return io::read_cell(cell, '.').kind == CellKind::text; });
}

/// Rows from before a restart of the device precede its header: returns where to begin instead.
std::size_t last_header(std::span<const HeldLine> lines, const io::CsvLayout& layout) {
  std::vector<std::string_view> cells;
  for (std::size_t l = lines.size(); l-- > layout.first_line;) {
    io::split_fields(lines[l].text, layout.separator, cells);
    const bool is_followed = l + 1 < lines.size();
    if (is_followed && layout.columns.size() > 1 && cells.size() == layout.columns.size() &&
        is_words_only(lines[l].text, layout.separator))
      return l;
  }
  return 0;
}

RowField field_of(std::string heading, io::ColumnLabel label, ColumnKind kind) {
  return {.heading = std::move(heading),
          .label = std::move(label),
          .is_figures = kind == ColumnKind::number || kind == ColumnKind::blank,
          .is_calendar = kind == ColumnKind::clock || kind == ColumnKind::time_of_day};
}

/// Names from columns=, else by position.
std::vector<std::string> given_headings(std::size_t width, const FramingOptions& options) {
  if (!options.columns.empty()) return options.columns;
  std::vector<std::string> headings;
  for (std::size_t c = 0; c < width; ++c) headings.push_back(fmt::format("c{}", c + 1));
  return headings;
}

/// Sets the fields' names if the header gives none.
void name_by_settings(const FramingOptions& options, io::CsvHeader& header) {
  const std::size_t width = header.labels.size();
  header.labels.clear();
  header.notes.clear();
  for (const std::string& heading : given_headings(width, options))
    header.labels.push_back(io::read_label(heading));
  io::complete_names(header.labels, header.notes);
}

/// The lines begin where the layout was found.
Result<FoundDialect> table_of(std::span<const HeldLine> lines,
                              const io::CsvLayout& layout,
                              const FramingOptions& options) {
  io::CsvHeader header = io::read_header(layout);
  const std::size_t width = header.labels.size();
  if (!header.found && !options.columns.empty() && options.columns.size() != width)
    return Error{Errc::invalid_argument, fmt::format("columns= names {} columns, the lines have {}",
                                                     options.columns.size(), width)};
  if (!header.found) name_by_settings(options, header);
  std::vector<RowField> fields;
  for (std::size_t c = 0; c < width; ++c) {
    const bool is_given = !header.found && !options.columns.empty();
    fields.push_back(field_of(is_given ? options.columns[c] : header.labels[c].name,
                              header.labels[c], layout.columns[c]));
  }
  std::string header_text;
  if (header.found) header_text = io::trimmed(lines[header.line - 1].text);
  const bool has_names = header.found || !options.columns.empty();
  return FoundDialect{
      std::make_unique<Table>(layout, std::move(fields), has_names, std::move(header_text)),
      layout.first_line - 1, std::move(header.notes)};
}

}  // namespace

std::optional<Tick> tick_in(std::string_view figure, char point) {
  const bool is_negative = figure.starts_with('-');
  const char* const end = figure.data() + figure.size();
  Tick tick;
  const auto whole = std::from_chars(figure.data(), end, tick.whole);
  if (whole.ec == std::errc{} && whole.ptr == end) return tick;
  if (whole.ec == std::errc{} && !is_negative && *whole.ptr == point) {
    std::int64_t nano = 0;
    const char* p = whole.ptr + 1;
    for (std::int64_t weight = ns_per_s / 10; p != end && *p >= '0' && *p <= '9'; ++p) {
      nano += weight * (*p - '0');
      weight /= 10;
    }
    if (p == end) return Tick{tick.whole, static_cast<std::int32_t>(nano)};
  }
  const io::Cell cell = io::read_cell(figure, point);
  return cell.kind == CellKind::number ? tick_of(cell.value) : std::nullopt;
}

Result<FoundDialect> find_table(std::span<const HeldLine> lines, const FramingOptions& options) {
  std::size_t first = 0;
  auto layout = io::infer_layout(joined(lines), true);
  const auto begin_at = [&](std::size_t line) {
    first = line;
    layout = io::infer_layout(joined(lines.subspan(first)), true);
  };
  const bool is_midway = options.carrier == Carrier::stream;
  if (layout && is_midway && lines.size() > 1 &&
      !is_words_only(lines.front().text, layout->separator))
    begin_at(1);
  if (layout && is_midway)
    if (const std::size_t header = last_header(lines.subspan(first), *layout); header > 0)
      begin_at(first + header);
  if (!layout) return FoundDialect{};
  auto table = table_of(lines.subspan(first), *layout, options);
  if (!table) return table.error();
  FoundDialect found = std::move(table).value();
  found.begin += first;
  return found;
}

}  // namespace proofmass::acquire
