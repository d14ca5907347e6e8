#include "proofmass/io/csv/rows.hpp"

#include <algorithm>
#include <limits>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool has_values(ColumnUse use) {
  return use == ColumnUse::keep || use == ColumnUse::stamps;
}

template <bool BlankSeparated>
const char* skip_blanks(const char* p) {
  while (*p == ' ' || (BlankSeparated && *p == '\t')) ++p;
  return p;
}

/// End of an empty field or a plain "nan"; nullptr if it is neither.
const char* scan_missing(const char* p, char separator, char line_end) {
  if (*p == separator || *p == line_end) return p;
  if ((p[0] | 0x20) == 'n' && (p[1] | 0x20) == 'a' && (p[2] | 0x20) == 'n') return p + 3;
  return nullptr;
}

/// End of a text field; nullptr if it contains quotes or zeros.
const char* scan_words(const char* p, char separator, char line_end) {
  for (; *p != separator && *p != line_end; ++p)
    if (*p == '"' || *p == '\0' || (separator == ' ' && *p == '\t')) return nullptr;
  return p;
}

/// Start of the next field; nullptr if there is none.
template <bool BlankSeparated>
const char* scan_separator(const char* p, char separator) {
  if constexpr (BlankSeparated) return *p == ' ' || *p == '\t' ? p : nullptr;
  p = skip_blanks<false>(p);
  return *p == separator ? p + 1 : nullptr;
}

/// Start of the next line, after at most one separator; nullptr if the row continues.
template <bool BlankSeparated>
const char* scan_row_end(const char* p, char separator, char line_end) {
  p = skip_blanks<BlankSeparated>(p);
  if (!BlankSeparated && *p == separator) p = skip_blanks<false>(p + 1);
  if (*p == '\r' && line_end == '\n') ++p;
  return *p == line_end ? p + 1 : nullptr;
}

/// Parameters of the loop below, held in registers.
struct Marks {
  char separator;
  char point;
  char line_end;
  bool can_be_missing;  ///< not for empty lines, nor with blanks as separators
};

/// One plain number, or an empty field; nullptr for anything else. A stamp is relative to the
/// first.
// A function call per number costs a tenth of the speed.
[[gnu::always_inline]] inline const char* parse_value(const char* p,
                                                      const Marks& marks,
                                                      const StampReader* stamps,
                                                      double& out) {
  Decimal figure;
  const char* end = scan_decimal(p, marks.point, figure);
  if (end == nullptr) {
    out = nan;
    return marks.can_be_missing ? scan_missing(p, marks.separator, marks.line_end) : nullptr;
  }
  if (stamps != nullptr) return stamps->relative(figure, out) ? end : nullptr;
  if (!to_double_exactly(figure, out)) out = to_double(figure);
  return end;
}

}  // namespace

CsvRows::CsvRows(const CsvLayout& layout,
                 std::vector<ColumnUse> uses,
                 std::optional<StampReader> stamps,
                 std::optional<std::size_t> date_column,
                 std::size_t expected_rows)
    : layout_(layout),
      uses_(std::move(uses)),
      stamps_(stamps),
      date_column_(date_column),
      line_(layout.first_line) {
  for (const ColumnUse use : uses_) {
    const std::size_t column = slots_.size();
    slots_.push_back(use == ColumnUse::words ? word_runs_.size() : columns_.size());
    if (use == ColumnUse::words) word_runs_.push_back(&words_[column]);
    if (has_values(use)) columns_.emplace_back(expected_rows);
  }
  row_words_.resize(word_runs_.size());
  gathered_.resize(block * columns_.size());
  plain_ = !stamps_ || stamps_->spelling() == StampSpelling::figures;
}

void CsvRows::commit() {
  if (pending_gap_) faults_.out_of_step = true;
  if (!word_runs_.empty()) commit_words();
  ++rows_;
  if (++gathered_rows_ == block) flush();
}

void CsvRows::commit_words() {
  for (std::size_t w = 0; w < word_runs_.size(); ++w) word_runs_[w]->add(rows_, row_words_[w]);
}

void CsvRows::flush() {
  for (std::size_t c = 0; c < columns_.size(); ++c)
    columns_[c].append(std::span(gathered_).subspan(c * block, gathered_rows_));
  gathered_rows_ = 0;
}

std::vector<double> CsvRows::take(std::size_t column) {
  return columns_[slots_[column]].take();
}

/// End of a text field, which is stored if it is used; nullptr if it contains quotes or zeros.
const char* CsvRows::parse_words(const char* begin, std::size_t column) {
  const char* end = scan_words(begin, layout_.separator, layout_.line_end);
  if (uses_[column] == ColumnUse::words && end != nullptr)
    row_words_[slots_[column]] = {begin, static_cast<std::size_t>(end - begin)};
  return end;
}

/// Parses one row of plain numbers directly from the text; nullptr, with no relevant change, if
/// there is anything else in it. This loop determines the reader's speed.
template <bool BlankSeparated>
const char* CsvRows::parse_plain(const char* p) {
  const Marks marks{layout_.separator, layout_.point, layout_.line_end,
                    !BlankSeparated && uses_.size() > 1};
  double* out = gathered_.data() + gathered_rows_;
  const std::size_t width = uses_.size();
  for (std::size_t c = 0;;) {
    p = skip_blanks<BlankSeparated>(p);
    const ColumnUse use = uses_[c];
    if (!has_values(use)) {
      p = parse_words(p, c);
    } else {
      p = parse_value(p, marks, use == ColumnUse::stamps ? &*stamps_ : nullptr, *out);
      out += block;
    }
    if (p == nullptr) return nullptr;
    if (++c == width) return scan_row_end<BlankSeparated>(p, marks.separator, marks.line_end);
    p = scan_separator<BlankSeparated>(p, marks.separator);
    if (p == nullptr) return nullptr;
  }
}

/// End of the row that starts here: the end of its line, or of the line that closes a quoted text
/// over several lines. A quote that none of the next lines closes is an ordinary character.
const char* CsvRows::end_of_row(const char* begin, const char* end) {
  const char* line_end = std::find(begin, end, layout_.line_end);
  const std::string_view line(begin, static_cast<std::size_t>(line_end - begin));
  if (!leaves_quote_open(line, layout_.separator)) return line_end;
  constexpr std::size_t most_lines = 64;
  const char* close = line_end;
  for (std::size_t lines = 1; lines <= most_lines && close < end; ++lines) {
    const char* next = std::find(close + 1, end, layout_.line_end);
    const bool closes = std::find(close + 1, next, '"') != next;
    close = next;
    if (!closes || close == end) continue;
    line_ += lines;
    faults_.out_of_step = true;
    return close;
  }
  return line_end;
}

template <bool BlankSeparated>
void CsvRows::parse_lines(const char* begin, const char* end) {
  while (begin < end) {
    const char* next = plain_ ? parse_plain<BlankSeparated>(begin) : nullptr;
    if (next != nullptr) {
      commit();
    } else {
      const char* line_end = end_of_row(begin, end);
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

/// A line of any kind. If it contains zeros (a file system that lost the last block), the text
/// before them is truncated.
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

/// The value for a kept column; NaN with a note if there is none.
double CsvRows::read_field(std::size_t column, std::size_t fields) {
  if (column >= fields) return nan;
  if (uses_[column] == ColumnUse::stamps) {
    const bool dated = date_column_ && *date_column_ < fields;
    if (layout_.is_grouped) {
      const std::string plain = without_grouping(fields_[column], layout_.point);
      if (!plain.empty()) return stamps_->read(plain);
    }
    return stamps_->read(fields_[column], dated ? fields_[*date_column_] : std::string_view{});
  }
  const Cell cell = read_cell(fields_[column], layout_.point, layout_.is_grouped);
  if (layout_.is_grouped) note_grouping(column);
  if (cell.kind == CellKind::text) {
    faults_.words[column].add(line_);
    faults_.first_word.try_emplace(column, trimmed(fields_[column]).substr(0, 24));
    if (layout_.columns[column] == ColumnKind::blank) words_[column].add(rows_, fields_[column]);
  }
  return cell.value;
}

/// Number of usable fields; a wrong count is noted.
std::size_t CsvRows::usable_fields(bool is_cut) {
  const std::size_t width = uses_.size();
  std::size_t count = fields_.size();
  // The last field of a truncated line may have lost digits: a complete row without its line end is
  // accepted only if nothing indicates otherwise.
  const bool ended = count > width || (count == width && !layout_.trailing_separator);
  if (is_cut && !ended) {
    faults_.cut.add(line_);
    return count - 1;
  }
  if (count == width + 1 && trimmed(fields_.back()).empty()) --count;
  if (count < width) faults_.narrow.add(line_);
  if (count > width) faults_.wide.add(line_);
  return count;
}

/// True if a kept field contains a number or nothing, not a word.
bool CsvRows::is_figure(std::size_t column) const {
  if (!has_values(uses_[column])) return false;
  if (uses_[column] == ColumnUse::stamps && !plain_) return !trimmed(fields_[column]).empty();
  return read_cell(fields_[column], layout_.point, layout_.is_grouped).kind != CellKind::text;
}

void CsvRows::note_grouping(std::size_t column) {
  if (without_grouping(fields_[column], layout_.point).empty()) return;
  faults_.grouped[column].add(line_);
  faults_.first_grouped.try_emplace(column, trimmed(fields_[column]).substr(0, 24));
}

void CsvRows::parse_fields(std::string_view line, bool is_cut) {
  const bool is_empty = line.find_first_not_of(" \t\f\x1A") == std::string_view::npos;
  const bool is_comment = !is_empty && is_remark(line, layout_.separator);
  if (is_comment) faults_.remarks.add(line_);
  if (is_empty || is_comment) {
    pending_gap_ = true;
    return;
  }
  split_fields(line, layout_.separator, fields_);
  const std::size_t count = usable_fields(is_cut);
  std::size_t first_figure = 0;
  const std::size_t used = std::min(count, uses_.size());
  while (first_figure < used && !is_figure(first_figure)) ++first_figure;
  if (first_figure == used) {
    if (!is_cut) faults_.unreadable.add(line_);
    if (!is_cut && count == uses_.size() && wordy_lines_.size() < most_wordy_lines)
      wordy_lines_.push_back({line_, false, std::string(line)});
    pending_gap_ = true;
    return;
  }
  read_row(count);
  commit();
}

/// Stores the row's values and words from its first `count` fields.
void CsvRows::read_row(std::size_t count) {
  double* out = gathered_.data() + gathered_rows_;
  for (std::size_t c = 0; c < uses_.size(); ++c) {
    if (uses_[c] == ColumnUse::words)
      row_words_[slots_[c]] = c < count ? fields_[c] : std::string_view{};
    if (!has_values(uses_[c])) continue;
    *out = read_field(c, count);
    out += block;
  }
}

}  // namespace proofmass::io
