#include "proofmass/io/csv/notes.hpp"

#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/reading/channel_units.hpp"

namespace proofmass::io {
namespace {

std::string_view name_of_separator(char separator) {
  switch (separator) {
    case ',':
      return "comma";
    case ';':
      return "semicolon";
    case '\t':
      return "tab";
    case '|':
      return "bar";
    case ' ':
      return "blanks";
    default:
      return "other";
  }
}

std::string rows_from(const Seen& seen, std::string_view fault) {
  return seen.count == 1
             ? fmt::format("line {} {}", seen.first_line, fault)
             : fmt::format("{} lines, the first {}, {}", seen.count, seen.first_line, fault);
}

/// A channel whose numbers cannot be read is not a text column: it is lost. It is recognised by its
/// unit, its name or the appearance of its fields.
void note_lost_channels(const CsvLayout& layout,
                        const CsvHeader& header,
                        const CsvColumns& columns,
                        std::vector<Note>& notes) {
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (layout.columns[c] != ColumnKind::text || columns.date == c) continue;
    const ColumnLabel& label = header.labels[c];
    const std::string& figure = layout.odd_figures[c];
    const bool is_measured = label.unit.quantity != Quantity::unknown ||
                             (header.found && is_accelerometer_name(label.name));
    if (!is_measured && figure.empty()) continue;
    notes.push_back(
        {Severity::bad,
         fmt::format("{}: its fields are not numbers{}: the channel is lost", label.name,
                     figure.empty() ? "" : fmt::format(", as \"{}\" is none", figure))});
  }
}

/// Notes on the use of the text columns.
void note_words(const CsvHeader& header, const CsvColumns& columns, std::vector<Note>& notes) {
  if (columns.labels)
    notes.push_back({Severity::info, fmt::format("{}: words, kept as labels",
                                                 header.labels[*columns.labels].name)});
  std::string words;
  std::size_t count = 0;
  for (std::size_t c = 0; c < columns.uses.size(); ++c) {
    const bool is_read = columns.uses[c] == ColumnUse::keep || columns.uses[c] == ColumnUse::stamps;
    if (is_read || columns.date == c || columns.labels == c) continue;
    if (++count <= 8) words += (words.empty() ? "" : ", ") + header.labels[c].name;
  }
  if (count > 0)
    notes.push_back({Severity::info,
                     fmt::format("{}{}: left out, being words", words, count > 8 ? ", …" : "")});
}

}  // namespace

void note_layout(const CsvLayout& layout,
                 const CsvHeader& header,
                 const CsvColumns& columns,
                 std::vector<Note>& notes) {
  const std::string head =
      header.found ? fmt::format("header on line {}", header.line) : "no header";
  notes.push_back(
      {Severity::info,
       fmt::format("CSV: separator {}, decimal {}, {}, rows of {} fields from line {}",
                   name_of_separator(layout.separator), layout.point == '.' ? "point" : "comma",
                   head, layout.columns.size(), layout.first_line)});
  notes.insert(notes.end(), header.notes.begin(), header.notes.end());
  note_words(header, columns, notes);
  note_lost_channels(layout, header, columns, notes);
}

void note_faults(const RowFaults& faults,
                 const CsvHeader& header,
                 const CsvColumns& columns,
                 char point,
                 std::vector<Note>& notes) {
  const auto report = [&](Severity severity, const Seen& seen, std::string_view fault) {
    if (seen.count > 0) notes.push_back({severity, rows_from(seen, fault)});
  };
  report(Severity::warning, faults.narrow, "too short: the missing fields are NaN");
  report(Severity::warning, faults.wide, "too long: fields beyond the last column are skipped");
  report(Severity::warning, faults.unreadable, "without a number: skipped");
  report(Severity::warning, faults.cut, "breaks off: its last field is not used");
  report(Severity::warning, faults.nul, "holding bytes of zero, as a power cut leaves them");
  report(Severity::info, faults.remarks, "a remark between the rows: skipped");
  for (const auto& [column, seen] : faults.grouped) {
    const std::string& first = faults.first_grouped.at(column);
    notes.push_back({Severity::warning,
                     fmt::format("{}: thousands are separated, as in \"{}\" on line {}, read as {}",
                                 header.labels[column].name, first, seen.first_line,
                                 without_grouping(first, point))});
  }
  constexpr std::size_t most_columns_listed = 16;
  std::size_t listed = 0;
  for (const auto& [column, seen] : faults.words) {
    if (columns.labels == column) continue;
    if (++listed > most_columns_listed) break;
    notes.push_back(
        {Severity::warning,
         fmt::format("{}: {} not a number, the first \"{}\" on line {}: NaN",
                     header.labels[column].name,
                     seen.count == 1 ? "1 field is" : fmt::format("{} fields are", seen.count),
                     faults.first_word.at(column), seen.first_line)});
  }
  if (listed > most_columns_listed)
    notes.push_back(
        {Severity::warning,
         fmt::format("{} columns in all have fields that are not numbers", faults.words.size())});
}

}  // namespace proofmass::io
