#include "proofmass/io/lvm/table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::lvm {
namespace {

bool is_together(const Channel& one, const Channel& other, XColumns x) {
  if (one.delta_text != other.delta_text) return false;
  // A single X value per row shows that all channels belong together.
  if (x == XColumns::one || one.delta_x == 0.0) return true;
  if (one.start_ns.has_value() != other.start_ns.has_value()) return false;
  double apart_s = other.x0 - one.x0;
  if (one.start_ns)
    apart_s +=
        static_cast<double>(*other.start_ns) * 1e-9 - static_cast<double>(*one.start_ns) * 1e-9;
  // Channels sampled one after another by a multiplexer belong to one scan; software may take some
  // time between single samples.
  return std::abs(apart_s) <= std::max(one.delta_x, 1e-3);
}

Table table_of(const Segment& segment, const Channel& first, XColumns x) {
  Table table;
  table.x_is_time = segment.x_is_time;
  table.x_heading = segment.x_heading;
  if (x == XColumns::multi) table.x_column = first.column - 1;
  return table;
}

bool is_figure(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+';
}

/// True if there is a number, or a word for a missing one; the first field may not be a word.
bool has_figure(std::string_view line, const File& file) {
  for (bool is_first = true; !line.empty(); is_first = false) {
    const std::size_t end = std::min(line.find(file.separator), line.size());
    const std::string_view field = line.substr(0, end);
    const CellKind kind = read_cell(field, file.point).kind;
    if (kind == CellKind::text && is_first) return false;
    const bool is_word_for_none = kind == CellKind::missing && !trimmed(field).empty();
    if (kind == CellKind::number || is_word_for_none) return true;
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return false;
}

}  // namespace

std::uint64_t Table::rows() const {
  std::uint64_t all = 0;
  for (const Rows& segment : segments) all += segment.count;
  return all;
}

std::vector<Table> tables_of(const Segment& segment, XColumns x) {
  constexpr std::size_t most_tables = 64;
  std::vector<Table> tables;
  const auto longest = std::ranges::max_element(segment.channels, {}, &Channel::samples);
  for (auto channel = segment.channels.begin(); channel != segment.channels.end(); ++channel) {
    auto table = std::ranges::find_if(tables, [&](const Table& other) {
      return is_together(other.channels.front(), *channel, x);
    });
    if (table == tables.end() && tables.size() == most_tables) table = tables.end() - 1;
    if (table == tables.end()) table = tables.insert(table, table_of(segment, *channel, x));
    if (x == XColumns::one && channel == longest) table->x_column = 0;
    table->columns_in_file = std::max(table->columns_in_file, channel->column + 1);
    table->channels.push_back(*channel);
  }
  if (!tables.empty()) tables.front().notes = segment.notes;
  for (Table& table : tables)
    if (const double delta_x = table.channels.front().delta_x; tables.size() > 1 && delta_x > 0.0)
      table.name = fmt::format(" at {} Hz", in_words(1.0 / delta_x));
  return tables;
}

bool is_data_row(std::string_view line, const File& file) {
  if (line.empty() || line.front() == '*') return false;
  // Nearly all rows begin with a number, or with a blank X value before one.
  if (is_figure(line.front())) return true;
  if (line.front() == file.separator && line.size() > 1 && is_figure(line[1])) return true;
  return !is_tag(line) && has_figure(line, file);
}

}  // namespace proofmass::io::lvm
