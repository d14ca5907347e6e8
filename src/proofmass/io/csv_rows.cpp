#include "proofmass/io/csv_rows.hpp"

#include <algorithm>
#include <limits>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Where an empty field or a plain "nan" ends; nullptr if it is neither.
const char* scan_missing(const char* p, char separator, char line_end) {
  if (*p == separator || *p == line_end) return p;
  if ((p[0] | 0x20) == 'n' && (p[1] | 0x20) == 'a' && (p[2] | 0x20) == 'n') return p + 3;
  return nullptr;
}

}  // namespace

CsvRows::CsvRows(const CsvLayout& layout,
                 std::vector<ColumnUse> uses,
                 std::optional<StampReader> stamps,
                 std::optional<std::size_t> date_column,
                 std::size_t expected_rows)
    : layout_(layout),
      uses_(std::move(uses)),
      stamps_(std::move(stamps)),
      date_column_(date_column),
      line_(layout.first_line) {
  for (const ColumnUse use : uses_) {
    slots_.push_back(columns_.size());
    if (use != ColumnUse::skip) columns_.emplace_back(expected_rows);
  }
  gathered_.resize(block * columns_.size());
  plain_ = !stamps_ || stamps_->spelling() == StampSpelling::figures;
}

void CsvRows::commit() {
  if (pending_gap_) faults_.out_of_step = true;
  ++rows_;
  if (++gathered_rows_ == block) flush();
}

void CsvRows::flush() {
  for (std::size_t c = 0; c < columns_.size(); ++c)
    columns_[c].append(std::span(gathered_).subspan(c * block, gathered_rows_));
  gathered_rows_ = 0;
}

void CsvRows::finish() {
  flush();
  std::vector<double>().swap(gathered_);
}

std::vector<double> CsvRows::take(std::size_t column) {
  return columns_[slots_[column]].take();
}

/// One row of plain figures, straight from the text; nullptr, with nothing changed that matters, if
/// there is anything else in it. This loop is the reader's speed.
template <bool blanks>
const char* CsvRows::parse_plain(const char* p) {
  const char separator = layout_.separator;
  const char point = layout_.point;
  const char line_end = layout_.line_end;
  const std::size_t width = uses_.size();
  double* out = gathered_.data() + gathered_rows_;
  const auto skip_blanks = [&] {
    while (*p == ' ' || (blanks && *p == '\t')) ++p;
  };
  for (std::size_t c = 0; c < width; ++c) {
    skip_blanks();
    if (uses_[c] == ColumnUse::skip) {
      for (; *p != separator && *p != line_end; ++p)
        if (*p == '"' || *p == '\0' || (blanks && *p == '\t')) return nullptr;
    } else {
      Decimal figure;
      const char* end = scan_decimal(p, point, figure);
      if (end == nullptr) {
        if (blanks || width == 1) return nullptr;
        end = scan_missing(p, separator, line_end);
        if (end == nullptr) return nullptr;
        *out = nan;
      } else if (uses_[c] == ColumnUse::stamps) {
        if (!stamps_->relative(figure, *out)) return nullptr;
      } else if (!to_double_exactly(figure, *out)) {
        *out = to_double(figure);
      }
      out += block;
      p = end;
    }
    if (c + 1 == width) break;
    if constexpr (blanks) {
      if (*p != ' ' && *p != '\t') return nullptr;
    } else {
      skip_blanks();
      if (*p != separator) return nullptr;
      ++p;
    }
  }
  skip_blanks();
  if (!blanks && *p == separator) {
    ++p;
    skip_blanks();
  }
  if (*p == '\r' && line_end == '\n') ++p;
  return *p == line_end ? p + 1 : nullptr;
}

template <bool blanks>
void CsvRows::parse_lines(const char* begin, const char* end) {
  while (begin < end) {
    const char* next = plain_ ? parse_plain<blanks>(begin) : nullptr;
    if (next != nullptr) {
      commit();
    } else {
      const char* line_end = std::find(begin, end, layout_.line_end);
      parse_any({begin, static_cast<std::size_t>(line_end - begin)}, false);
      next = line_end + 1;
    }
    ++line_;
    begin = next;
  }
}

void CsvRows::parse(const char* begin, const char* end) {
  if (layout_.separator == ' ')
    parse_lines<true>(begin, end);
  else
    parse_lines<false>(begin, end);
}

void CsvRows::parse_last(std::string_view line) {
  parse_any(line, true);
  ++line_;
}

/// A line of any kind. Where zeros are in it (a file system's way of losing the last block) what
/// stands before them broke off there.
void CsvRows::parse_any(std::string_view line, bool is_cut) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (const auto nul = line.find('\0'); nul != std::string_view::npos) {
    faults_.nul.add(line_);
    const auto last_nul = line.rfind('\0');
    parse_fields(line.substr(0, nul), true);
    line = line.substr(last_nul + 1);
  }
  parse_fields(line, is_cut);
}

/// The value for a kept column; NaN with a remark where there is none.
double CsvRows::read_field(std::size_t column, std::size_t fields) {
  if (column >= fields) return nan;
  if (uses_[column] == ColumnUse::stamps) {
    const bool dated = date_column_ && *date_column_ < fields;
    return stamps_->read(fields_[column], dated ? fields_[*date_column_] : std::string_view{});
  }
  const Cell cell = read_cell(fields_[column], layout_.point);
  if (cell.kind == CellKind::text) {
    faults_.words[column].add(line_);
    faults_.first_word.try_emplace(column, trimmed(fields_[column]).substr(0, 24));
  }
  return cell.value;
}

void CsvRows::parse_fields(std::string_view line, bool is_cut) {
  if (line.find_first_not_of(" \t\f\x1A") == std::string_view::npos) {
    pending_gap_ = true;
    return;
  }
  if (is_remark(line, layout_.separator)) {
    faults_.remarks.add(line_);
    pending_gap_ = true;
    return;
  }
  split_fields(line, layout_.separator, fields_);
  const std::size_t width = uses_.size();
  std::size_t count = fields_.size();
  // The last field of a line that broke off may have lost digits: a whole row without its line end
  // is taken for whole only where nothing shows otherwise.
  const bool ended = count > width || (count == width && !layout_.trailing_separator);
  if (is_cut && !ended) {
    faults_.cut.add(line_);
    fields_.pop_back();
    count = fields_.size();
  } else {
    const bool closed = count > 1 && trimmed(fields_.back()).empty();
    if (closed && count == width + 1) --count;
    if (count < width) faults_.narrow.add(line_);
    if (count > width) faults_.wide.add(line_);
  }
  const auto is_figure = [&](std::size_t c) {
    if (uses_[c] == ColumnUse::skip) return false;
    if (uses_[c] == ColumnUse::stamps && !plain_) return !trimmed(fields_[c]).empty();
    return read_cell(fields_[c], layout_.point).kind != CellKind::text;
  };
  bool any = false;
  for (std::size_t c = 0; c < std::min(count, width) && !any; ++c) any = is_figure(c);
  if (!any) {
    if (!is_cut) faults_.unreadable.add(line_);
    pending_gap_ = true;
    return;
  }
  double* out = gathered_.data() + gathered_rows_;
  for (std::size_t c = 0; c < width; ++c) {
    if (uses_[c] == ColumnUse::skip) continue;
    *out = read_field(c, count);
    out += block;
  }
  commit();
}

}  // namespace proofmass::io
