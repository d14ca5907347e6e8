#include "proofmass/io/positions/interval_list.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/positions/interval_columns.hpp"
#include "proofmass/io/positions/text_lines.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io {
namespace {

/// A line split into fields.
struct Row {
  std::size_t line = 0;
  std::vector<std::string> fields;
};

Error wrong(const Row& row, std::string_view what) {
  return {Errc::corrupt, fmt::format("line {}: {}", row.line, what)};
}

/// Interprets the rows of a list, one after another.
class IntervalReader {
 public:
  explicit IntervalReader(const IntervalColumns& columns) : columns_(columns) {}

  [[nodiscard]] Result<Interval> read(const Row& row) const {
    Interval interval;
    interval.line = row.line;
    interval.in_samples = columns_.in_samples();
    interval.start = figure(row, columns_.start.column) * columns_.start.unit_s;
    interval.end = figure(row, columns_.end.column) * columns_.end.unit_s;
    if (!std::isfinite(interval.start) || !std::isfinite(interval.end))
      return wrong(row, "start or end is not a number");
    if (const auto fault = fault_of(interval); !fault.empty()) return wrong(row, fault);
    interval.label = label_of(row);
    if (columns_.angle) {
      const double angle = figure(row, *columns_.angle) * columns_.angle_unit_rad;
      if (std::isfinite(angle)) interval.angle_rad = angle;
    }
    if (!columns_.up) return interval;
    return with_direction(std::move(interval), row);
  }

 private:
  [[nodiscard]] double figure(const Row& row, std::size_t column) const {
    if (column >= row.fields.size()) return std::nan("");
    return read_cell(row.fields[column], columns_.point).value;
  }

  /// Without a header the text is the remainder of the line.
  [[nodiscard]] std::string label_of(const Row& row) const {
    std::string label;
    if (!columns_.label) return label;
    for (std::size_t c = *columns_.label; c < row.fields.size(); ++c) {
      if (c > *columns_.label) label += columns_.separator;
      label += row.fields[c];
      if (columns_.has_header) break;
    }
    return label;
  }

  static std::string fault_of(const Interval& interval) {
    const auto is_whole = [](double x) { return x >= 0.0 && x == std::trunc(x) && x < 1e15; };
    if (interval.in_samples && (!is_whole(interval.start) || !is_whole(interval.end)))
      return "the number of a sample is whole and not below zero";
    // One sample is a valid interval, a single time is not.
    const bool is_empty = !interval.in_samples && interval.end == interval.start;
    if (interval.end < interval.start || is_empty)
      return fmt::format("ends at {}, which is not after its start at {}", in_words(interval.end),
                         in_words(interval.start));
    return {};
  }

  [[nodiscard]] Result<Interval> with_direction(Interval interval, const Row& row) const {
    std::array<double, 3> up{};
    bool any = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      up[axis] = figure(row, (*columns_.up)[axis]);
      any = any || !std::isnan(up[axis]);
    }
    if (!any) return interval;
    const double length = std::hypot(up[0], up[1], up[2]);
    if (!std::isfinite(length) || length == 0.0)
      return wrong(row, "the direction needs three figures that are not all zero");
    for (double& component : up) component /= length;
    interval.up = up;
    return interval;
  }

  IntervalColumns columns_;
};

/// True for lines of an Audacity track with a label's frequency range.
bool is_frequency_range(const Row& row) {
  return row.fields.front() == "\\";
}

Status check_apart(const std::vector<Interval>& intervals) {
  for (std::size_t i = 1; i < intervals.size(); ++i) {
    const Interval& before = intervals[i - 1];
    const Interval& after = intervals[i];
    const bool apart = after.in_samples ? after.start > before.end : after.start >= before.end;
    if (!apart)
      return Error{
          Errc::corrupt,
          fmt::format("line {}: begins at {}, within the interval of line {} that ends "
                      "at {}",
                      after.line, in_words(after.start), before.line, in_words(before.end))};
  }
  return Done{};
}

Result<std::vector<Interval>> intervals_in(const std::vector<TextLine>& lines) {
  const auto columns = find_interval_columns(lines);
  if (!columns) return columns.error();
  const IntervalReader reader(*columns);
  std::vector<Interval> intervals;
  for (std::size_t i = columns->has_header ? 1 : 0; i < lines.size(); ++i) {
    const Row row{lines[i].number, fields_of(lines[i], columns->separator)};
    if (is_frequency_range(row)) continue;
    auto interval = reader.read(row);
    if (!interval) return interval.error();
    intervals.push_back(std::move(interval).value());
  }
  if (intervals.empty()) return Error{Errc::too_few_samples, "has no interval"};
  std::ranges::sort(intervals, {}, [](const Interval& i) { return std::pair(i.start, i.line); });
  if (const Status apart = check_apart(intervals); !apart) return apart.error();
  return intervals;
}

Result<std::vector<Interval>> intervals_of(const Result<std::vector<TextLine>>& lines,
                                           const std::string& name) {
  const std::string where = name == "-" ? "standard input" : name;
  if (!lines) return lines.error().at(where);
  auto intervals = intervals_in(*lines);
  if (!intervals) return intervals.error().at(where);
  return intervals;
}

}  // namespace

Result<std::vector<Interval>> read_intervals(const std::string& path) {
  return intervals_of(read_lines(path), path);
}

Result<std::vector<Interval>> read_intervals(std::span<const std::byte> bytes,
                                             const std::string& name) {
  return intervals_of(read_lines(bytes), name);
}

Status check_inside(const std::vector<Interval>& intervals,
                    double duration_s,
                    std::size_t samples) {
  const double steps = samples > 1 ? static_cast<double>(samples) - 1.0 : 1.0;
  for (const Interval& interval : intervals) {
    const double last = interval.in_samples ? static_cast<double>(samples) - 1.0 : duration_s;
    // A minute at 100 Hz has its last sample at 59.99 s, but users write that it ends at 60 s.
    const double slack = interval.in_samples ? 0.0 : duration_s / steps * (1.0 + 1e-9);
    if (interval.start >= 0.0 && interval.end <= last + slack) continue;
    const std::string limit = interval.in_samples ? fmt::format("samples 0 to {}", in_words(last))
                                                  : fmt::format("0 s to {} s", in_words(last));
    return Error{
        Errc::invalid_argument,
        fmt::format("line {}: the interval from {} to {} is outside the recording, which "
                    "has {}",
                    interval.line, in_words(interval.start), in_words(interval.end), limit)};
  }
  return Done{};
}

}  // namespace proofmass::io
