#include "proofmass/io/lvm/rows.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/decimal.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::io::lvm {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Digits after the decimal mark of a number, without its exponent.
int decimals_in(std::string_view field, char point) {
  const std::size_t mark = field.find(point);
  if (mark == std::string_view::npos) return 0;
  const std::string_view after = field.substr(mark + 1);
  return static_cast<int>(std::min(after.find_first_not_of("0123456789"), after.size()));
}

}  // namespace

RowParser::RowParser(const RandomBytes& bytes, const File& file, const Table& table)
    : bytes_(bytes), file_(file), table_(table), stamps_(StampSpelling::figures, file.point) {
  uses_.assign(table.columns_in_file + 1, skipped);
  for (std::size_t c = 0; c < table.channels.size(); ++c) {
    const std::size_t column = table.channels[c].column;
    uses_[column] = static_cast<int>(c);
    if (file.x == XColumns::multi) uses_[column - 1] = further_x;
  }
  if (table.x_column) uses_[*table.x_column] = x_value;
  uses_[table.columns_in_file] = comment;
}

void RowParser::begin(const Rows& segment) {
  lines_ = std::make_unique<LineReader>(bytes_, segment.offset, segment.line);
}

Result<bool> RowParser::row(std::span<double> figures, double& x) {
  for (;;) {
    const auto there = lines_->next();
    if (!there || !*there) return there;
    if (is_data_row(lines_->text(), file_)) break;
  }
  parse(lines_->text(), figures, x);
  return true;
}

/// A separator inside a number can only be its decimal mark, which is then read with the number.
const char* RowParser::end_of_field(const char* begin, const char* end) const {
  if (file_.separator == file_.point && *begin != file_.separator) {
    Decimal decimal;
    const char* after = scan_decimal(begin, file_.point, decimal);
    if (after != nullptr && (after == end || *after == file_.separator)) return after;
  }
  const void* found = std::memchr(begin, file_.separator, static_cast<std::size_t>(end - begin));
  return found == nullptr ? end : static_cast<const char*>(found);
}

void RowParser::parse(std::string_view line, std::span<double> figures, double& x) {
  std::ranges::fill(figures, nan);
  x = nan;
  Row row;
  const char* p = line.data();
  const char* const end = p + line.size();
  for (const int use : uses_) {
    const char* after = nullptr;
    if (use >= 0) {
      after = parse_figure(p, end, figures[static_cast<std::size_t>(use)]);
      row.figures = static_cast<std::size_t>(use) + 1;
      row.last = {p, static_cast<std::size_t>(after - p)};
    } else {
      after = use == comment ? end : end_of_field(p, end);
      const std::string_view field(p, static_cast<std::size_t>(after - p));
      if (use == x_value) x = stamps_.read(trimmed(field));
      take_field(use, field, row);
    }
    if (after == end) break;
    p = after + 1;
  }
  judge(row, figures);
}

/// Handles the fields that are not channel values.
void RowParser::take_field(int use, std::string_view field, Row& row) {
  if (use == x_value) row.x = field;
  if (use == further_x && field != row.x && !trimmed(field).empty()) row.has_other_x = true;
  if (use == comment) take_comment(field);
}

void RowParser::judge(const Row& row, std::span<double> figures) {
  if (row.has_other_x && faults_.other_x++ == 0) faults_.other_x_line = lines_->number();
  if (decimals_ && lines_->is_ended()) return;
  // All numbers have the same count of decimals: fewer at the end of the file mean truncation.
  const int decimals = decimals_in(row.last, file_.point);
  if (!decimals_) decimals_ = decimals;
  const bool is_short =
      row.figures < figures.size() || (!row.last.empty() && decimals < *decimals_);
  if (lines_->is_ended() || !is_short) return;
  if (row.figures > 0) figures[row.figures - 1] = nan;
  faults_.cut_line = lines_->number();
}

/// End of the field; its value, or NaN.
const char* RowParser::parse_figure(const char* begin, const char* end, double& figure) {
  Decimal decimal;
  const char* after =
      *begin == file_.separator ? nullptr : scan_decimal(begin, file_.point, decimal);
  if (after != nullptr && (after == end || *after == file_.separator)) {
    if (!to_double_exactly(decimal, figure)) figure = to_double(decimal);
    return after;
  }
  after = end_of_field(begin, end);
  figure = read_figure({begin, static_cast<std::size_t>(after - begin)});
  return after;
}

double RowParser::read_figure(std::string_view field) {
  const Cell cell = read_cell(field, file_.point);
  if (cell.kind == CellKind::text && faults_.words++ == 0) {
    faults_.word_line = lines_->number();
    faults_.word = shown(field);
  }
  return cell.value;
}

void RowParser::take_comment(std::string_view field) {
  if (trimmed(field).empty() || faults_.comments++ > 0) return;
  faults_.comment_line = lines_->number();
  faults_.comment = shown(field);
}

}  // namespace proofmass::io::lvm
