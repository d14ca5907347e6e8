#include "proofmass/io/csv/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

struct Line {
  std::string_view text;
  std::size_t offset = 0;
  std::size_t number = 1;
};

std::string_view trimmed_blanks(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t") - first + 1);
}

bool is_blank(std::string_view line) {
  return line.find_first_not_of(std::string_view(" \t\r\0", 4)) == std::string_view::npos;
}

/// The complete lines of the text.
std::vector<Line> complete_lines(std::string_view text, char line_end, bool is_whole_text) {
  std::vector<Line> lines;
  std::size_t number = 1;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::size_t end = text.find(line_end, begin);
    if (end == std::string_view::npos && !is_whole_text && !lines.empty()) break;
    std::string_view line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back({line, begin, number});
    if (end == std::string_view::npos) break;
    begin = end + 1;
  }
  return lines;
}

/// "sep=;" on the first line, as written by spreadsheets.
std::optional<char> separator_line(std::string_view line) {
  line = trimmed(line);
  if (line.size() != 5 || (!line.starts_with("sep=") && !line.starts_with("SEP=")))
    return std::nullopt;
  return line[4];
}

struct Tally {
  std::size_t number = 0;
  std::size_t missing = 0;
  std::size_t text = 0;
  std::size_t date = 0;
  std::size_t clock = 0;
  std::size_t time_of_day = 0;

  void add(std::string_view field, char point, bool is_grouped) {
    switch (read_cell(field, point, is_grouped).kind) {
      case CellKind::number:
        ++number;
        return;
      case CellKind::missing:
        ++missing;
        return;
      case CellKind::text:
        break;
    }
    const auto reading = read_clock(field);
    if (!reading)
      ++text;
    else if (!reading->ns)
      ++date;
    else
      ++(reading->days ? clock : time_of_day);
  }
  [[nodiscard]] std::size_t clocks() const { return date + clock + time_of_day; }
  [[nodiscard]] ColumnKind kind() const {
    if (text + number + clocks() == 0) return ColumnKind::blank;
    if (text > number + clocks()) return ColumnKind::text;
    if (number >= clocks()) return ColumnKind::number;
    if (clock >= date && clock >= time_of_day) return ColumnKind::clock;
    return date > time_of_day ? ColumnKind::date : ColumnKind::time_of_day;
  }
};

/// One way to split the sampled lines, and its score.
struct Trial {
  char separator = ',';
  char point = '.';
  bool is_grouped = false;
  std::size_t width = 0;  ///< width of most lines, not counting an empty last field
  bool trailing = false;  ///< most lines of that width end in a separator
  double score = -1e300;
  std::vector<Tally> tallies{};
};

using Fielded = std::vector<std::vector<std::string_view>>;

std::size_t width_of(const std::vector<std::string_view>& fields) {
  const bool trailing = fields.size() > 1 && trimmed(fields.back()).empty();
  return fields.size() - (trailing ? 1 : 0);
}

/// The most frequent width; of two equally frequent ones the larger.
std::size_t commonest(const std::vector<std::size_t>& widths) {
  std::map<std::size_t, std::size_t> counts;
  for (const std::size_t width : widths) ++counts[width];
  std::size_t best = 0;
  for (const auto& [width, count] : counts)
    if (best == 0 || count >= counts[best]) best = width;
  return best;
}

/// True if a line contains this many names and nothing else: a header.
bool names_columns(const std::vector<std::string_view>& fields, std::size_t width, char point) {
  return fields.size() == width && std::ranges::all_of(fields, [&](std::string_view field) {
           return read_cell(field, point).kind == CellKind::text && !read_clock(field);
         });
}

/// True if the fields after the last column form another column, blank in most rows: it has a name,
/// or numbers too often for rows with an excess field. Else it is only a separator at the end.
bool has_last_column(const std::vector<Line>& lines,
                     const std::vector<std::vector<std::string_view>>& rows,
                     const Trial& trial) {
  std::size_t blank = 0;
  std::size_t filled = 0;
  for (const auto& fields : rows)
    if (fields.size() == trial.width + 1) ++(trimmed(fields.back()).empty() ? blank : filled);
  constexpr std::size_t often = 20;
  if (blank == 0 || filled * often >= rows.size()) return blank > 0;
  constexpr std::size_t longest_preamble = 64;
  std::vector<std::string_view> fields;
  for (std::size_t l = 0; l < std::min(lines.size(), longest_preamble); ++l) {
    split_fields(lines[l].text, trial.separator, fields);
    if (names_columns(fields, trial.width + 1, trial.point)) return true;
  }
  return false;
}

/// Scores the rows, and determines the columns from the last half of them: a header of several
/// lines may outnumber the rows of a short file.
void tally_columns(const std::vector<std::vector<std::string_view>>& rows, Trial& trial) {
  std::vector<Tally> all(trial.width);
  trial.tallies.assign(trial.width, {});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < trial.width; ++c) {
      all[c].add(rows[r][c], trial.point, trial.is_grouped);
      if (r >= rows.size() / 2) trial.tallies[c].add(rows[r][c], trial.point, trial.is_grouped);
    }
  }
  for (const Tally& tally : all)
    trial.score +=
        static_cast<double>(tally.number + tally.clocks()) - 1.5 * static_cast<double>(tally.text);
}

/// The lines of words before the first number are a header, which gives no information on how the
/// rows are separated; half of a short file may be header.
void drop_header(Fielded& rows, const Trial& trial) {
  const auto has_value = [&](const std::vector<std::string_view>& fields) {
    return std::ranges::any_of(fields, [&](std::string_view field) {
      return read_cell(field, trial.point, trial.is_grouped).kind == CellKind::number ||
             read_clock(field).has_value();
    });
  };
  const auto first = std::ranges::find_if(rows, has_value);
  if (first != rows.end()) rows.erase(rows.begin(), first);
}

Trial attempt(const std::vector<Line>& lines, const std::vector<Line>& sample, Trial trial) {
  trial.score = 0.0;
  const char separator = trial.separator;
  Fielded split;
  for (const Line& line : sample)
    if (!is_remark(line.text, separator)) split_fields(line.text, separator, split.emplace_back());
  drop_header(split, trial);
  std::vector<std::size_t> widths;
  for (const auto& fields : split) widths.push_back(width_of(fields));
  trial.width = std::min(commonest(widths), most_columns + 1);
  if (has_last_column(lines, split, trial)) ++trial.width;
  const std::size_t tried = split.size();
  std::erase_if(split, [&](const auto& fields) {
    return width_of(fields) != trial.width && fields.size() != trial.width;
  });
  trial.score = -static_cast<double>(tried - split.size());
  const auto trailing =
      std::ranges::count_if(split, [&](const auto& fields) { return fields.size() > trial.width; });
  trial.trailing = 2 * static_cast<std::size_t>(trailing) > split.size();
  tally_columns(split, trial);
  return trial;
}

bool header_is_one_wide(const std::vector<Line>& lines) {
  for (const Line& line : lines)
    if (!is_blank(line.text) && !is_remark(line.text, ','))
      return line.text.find(',') == std::string_view::npos;
  return false;
}

/// "0,5" below one name is a half, not two columns.
Trial halves_instead(const std::vector<Line>& lines, const std::vector<Line>& sample, Trial best) {
  if (best.separator != ',' || best.width != 2 || !header_is_one_wide(lines)) return best;
  Trial halves = attempt(lines, sample, {.separator = ';', .point = ','});
  return halves.width == 1 && halves.score > 0.0 ? halves : best;
}

/// The separators to try: the one given in the file, else the usual ones.
std::string separators_of(std::optional<char> given) {
  return given ? std::string(1, *given) : std::string(",;\t| ");
}

/// True if nine in ten lines have the same number of tabs, which then separate the columns: two
/// adjacent tabs are an empty field, not a wide blank.
bool has_even_tabs(const std::vector<Line>& sample) {
  std::map<std::size_t, std::size_t> counts;
  std::size_t lines = 0;
  for (const Line& line : sample) {
    if (is_remark(line.text, '\t')) continue;
    ++lines;
    ++counts[static_cast<std::size_t>(std::ranges::count(line.text, '\t'))];
  }
  return std::ranges::any_of(
      counts, [&](const auto& entry) { return entry.first > 0 && entry.second * 10 >= lines * 9; });
}

/// The numbers of each column, those with a comma and the others.
class NumbersByComma {
 public:
  explicit NumbersByComma(std::size_t columns) : plain_(columns), marked_(columns) {}

  /// False if the comma of a number cannot group thousands.
  bool take(std::size_t column, std::string_view field) {
    const Cell cell = read_cell(field, ',');
    if (cell.kind != CellKind::number) return true;
    const bool has_comma = field.find(',') != std::string_view::npos;
    if (has_comma && without_grouping(field, '.').empty()) return false;
    if (cell.value != 0.0) (has_comma ? marked_ : plain_)[column].push_back(std::abs(cell.value));
    return true;
  }

  /// True if some column has both, and wherever it has, those with a comma, as decimals, are nearer
  /// to a thousandth of the others than to them.
  [[nodiscard]] bool continue_as_thousands() const {
    std::size_t continued = 0;
    for (std::size_t c = 0; c < plain_.size(); ++c) {
      if (plain_[c].empty() || marked_[c].empty()) continue;
      const double step = std::log10(*median(plain_[c]) / *median(marked_[c]));
      if (std::abs(step) < std::abs(step - 3.0)) return false;
      ++continued;
    }
    return continued > 0;
  }

 private:
  std::vector<std::vector<double>> plain_, marked_;
};

/// Thousands separated by commas in a table with semicolons or tabs look like decimals: "999",
/// "1,000". They are thousands if no number of the file has a comma in any other position, and the
/// numbers with one continue those of their column without one.
bool commas_are_thousands(const std::vector<Line>& lines, const Trial& trial) {
  NumbersByComma numbers(trial.width);
  std::vector<std::string_view> fields;
  for (const Line& line : lines) {
    split_fields(line.text, trial.separator, fields);
    if (is_remark(line.text, trial.separator) || width_of(fields) != trial.width) continue;
    for (std::size_t c = 0; c < trial.width; ++c)
      if (!numbers.take(c, fields[c])) return false;
  }
  return numbers.continue_as_thousands();
}

/// The best way to split the lines for separators and decimal marks of the usual kinds.
Trial best_of(const std::vector<Line>& lines,
              const std::vector<Line>& sample,
              const std::string& separators) {
  Trial best;
  const bool has_tabs = has_even_tabs(sample);
  const auto take_if_better = [&](char separator, char point, bool is_grouped) {
    if (separator == point) return;
    if (separator == ' ' && has_tabs && best.separator == '\t' && best.score > 0.0) return;
    Trial trial =
        attempt(lines, sample, {.separator = separator, .point = point, .is_grouped = is_grouped});
    // A comma in a line without any separator is one, except for halves_instead().
    const bool separates = point != ',' || trial.width > 1;
    if (separates && trial.score > best.score) best = std::move(trial);
  };
  for (const bool is_grouped : {false, true})
    for (const char point : {'.', ','})
      for (const char separator : separators) take_if_better(separator, point, is_grouped);
  return best;
}

Trial best_trial(const std::vector<Line>& lines,
                 const std::vector<Line>& sample,
                 std::optional<char> given) {
  Trial best = best_of(lines, sample, separators_of(given));
  if (!given) best = halves_instead(lines, sample, std::move(best));
  if (best.point == ',' && best.separator != ',' && commas_are_thousands(lines, best))
    return attempt(lines, sample, {.separator = best.separator, .point = '.', .is_grouped = true});
  return best;
}

/// Lines for the decision: the last of those examined, which are rows whatever precedes them.
std::vector<Line> sample_of(const std::vector<Line>& lines) {
  const std::size_t most = std::clamp<std::size_t>((lines.size() + 1) / 2, 20, 200);
  std::vector<Line> sample;
  for (auto line = lines.rbegin(); line != lines.rend() && sample.size() < most; ++line)
    if (!is_blank(line->text)) sample.push_back(*line);
  std::ranges::reverse(sample);
  return sample;
}

bool is_row(const std::vector<std::string_view>& fields, const CsvLayout& layout) {
  if (width_of(fields) != layout.columns.size() && fields.size() != layout.columns.size())
    return false;
  bool any = false;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    if (layout.columns[c] == ColumnKind::text) continue;
    // Words that occur only in some rows may occur in the very first.
    if (layout.columns[c] == ColumnKind::blank) {
      any = any || read_cell(fields[c], layout.point, layout.is_grouped).kind == CellKind::number;
      continue;
    }
    const CellKind kind = read_cell(fields[c], layout.point, layout.is_grouped).kind;
    const bool stands_for_value = layout.columns[c] == ColumnKind::number
                                      ? kind == CellKind::number
                                      : read_clock(fields[c]).has_value();
    if (kind == CellKind::text && !stands_for_value) return false;
    any = any || stands_for_value;
  }
  return any;
}

/// The text of a comment without its mark.
std::string without_mark(std::string_view line) {
  const auto first = line.find_first_not_of(" \t#%;/");
  return std::string(first == std::string_view::npos ? std::string_view{} : line.substr(first));
}

/// True if it increases over the rows examined, except for one in ten.
bool first_column_ascends(const std::vector<Line>& rows, const CsvLayout& layout) {
  if (layout.columns.empty() || layout.columns[0] != ColumnKind::number) return false;
  std::vector<std::string_view> fields;
  std::size_t up = 0;
  std::size_t steps = 0;
  double last = std::nan("");
  for (const Line& row : rows) {
    split_fields(row.text, layout.separator, fields);
    const double value = read_cell(fields.front(), layout.point, layout.is_grouped).value;
    if (!std::isnan(last) && !std::isnan(value)) {
      ++steps;
      if (value > last) ++up;
    }
    last = value;
  }
  return steps >= 2 && up * 10 >= steps * 9;
}

bool looks_binary(std::string_view head) {
  constexpr std::string_view usual("\t\n\r\0\f\x1A", 6);
  const auto odd = std::ranges::count_if(head, [&](char c) {
    return static_cast<unsigned char>(c) < 32 && usual.find(c) == std::string_view::npos;
  });
  return static_cast<std::size_t>(odd) * 50 > head.size();
}

/// Stores the lines before the first row as the preamble; returns the rows.
std::vector<Line> find_rows(const std::vector<Line>& lines, CsvLayout& layout) {
  std::vector<std::string_view> fields;
  std::vector<Line> rows;
  for (const Line& line : lines) {
    if (is_blank(line.text) || (line.number == 1 && separator_line(line.text))) continue;
    const bool remark = is_remark(line.text, layout.separator);
    split_fields(line.text, layout.separator, fields);
    if (!remark && is_row(fields, layout)) {
      rows.push_back(line);
    } else if (rows.empty()) {
      layout.preamble.push_back(
          {line.number, remark, remark ? without_mark(line.text) : std::string(line.text)});
    }
  }
  return rows;
}

/// True if a word is a number in an ambiguous notation: "(0.5)", "5 %", "1.5 g", "1.5D-3",
/// full-width digits.
bool is_odd_figure(std::string_view word) {
  constexpr std::string_view figures = "0123456789.,'_() %";
  word = trimmed(word);
  if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
  constexpr std::string_view full_width = "\xEF\xBC";  // prefix of U+FF00 … U+FF3F
  bool has_digit = false;
  while (!word.empty()) {
    const bool is_wide = word.starts_with(full_width) && word.size() > 2;
    // Bytes of other characters, such as blanks and minus signs, are neutral.
    const bool is_other = static_cast<unsigned char>(word[0]) >= 0x80;
    if (!is_wide && !is_other && figures.find(word[0]) == std::string_view::npos) break;
    has_digit = has_digit || is_wide || is_digit(word[0]);
    word.remove_prefix(is_wide ? 3 : 1);
  }
  if (!has_digit) return false;
  if (!word.empty() && (word[0] == 'D' || word[0] == 'd')) {
    word.remove_prefix(1);
    if (word.starts_with('+') || word.starts_with('-')) word.remove_prefix(1);
    return !word.empty() && std::ranges::all_of(word, is_digit);
  }
  return word.empty() || parse_unit(word).has_value();
}

/// Text columns that are mostly odd numbers.
void note_odd_figures(const std::vector<Line>& rows, CsvLayout& layout) {
  const std::size_t width = layout.columns.size();
  layout.odd_figures.assign(width, {});
  std::vector<std::size_t> odd(width, 0), words(width, 0);
  std::vector<std::string_view> fields;
  for (const Line& row : rows) {
    split_fields(row.text, layout.separator, fields);
    for (std::size_t c = 0; c < std::min(width, fields.size()); ++c) {
      if (layout.columns[c] != ColumnKind::text || trimmed(fields[c]).empty()) continue;
      ++words[c];
      if (!is_odd_figure(fields[c])) continue;
      if (odd[c]++ == 0) layout.odd_figures[c] = trimmed(fields[c]).substr(0, 24);
    }
  }
  for (std::size_t c = 0; c < width; ++c)
    if (odd[c] * 2 <= words[c]) layout.odd_figures[c].clear();
}

/// Fills in the position of the rows and the preceding lines; false if there is no row.
bool place_rows(const std::vector<Line>& lines, CsvLayout& layout) {
  const std::vector<Line> rows = find_rows(lines, layout);
  if (rows.empty()) return false;
  layout.data_offset = rows.front().offset;
  layout.first_line = rows.front().number;
  std::size_t bytes = 0;
  for (const Line& row : rows) bytes += row.text.size() + 1;
  layout.bytes_per_row = static_cast<double>(bytes) / static_cast<double>(rows.size());
  layout.first_ascends = first_column_ascends(rows, layout);
  note_odd_figures(rows, layout);
  return true;
}

/// End of the field that starts at `begin`; separators within quotes are ignored.
std::size_t end_of_field(std::string_view line, std::size_t begin, char separator) {
  const std::string_view separators = separator == ' ' ? " \t" : std::string_view(&separator, 1);
  std::size_t i = begin;
  while (i < line.size() && line[i] == ' ') ++i;
  if (i < line.size() && line[i] == '"') {
    const std::size_t close = line.find('"', i + 1);
    if (close != std::string_view::npos) i = close;
  }
  return std::min(line.find_first_of(separators, i), line.size());
}

}  // namespace

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') line = trimmed_blanks(line);
  for (std::size_t begin = 0; fields.size() <= most_columns;) {
    const std::size_t end = end_of_field(line, begin, separator);
    fields.push_back(line.substr(begin, end - begin));
    if (end == line.size()) return;
    begin = end + 1;
    if (separator == ' ') begin = line.find_first_not_of(" \t", begin);
  }
}

bool leaves_quote_open(std::string_view line, char separator) {
  for (std::size_t begin = 0; begin < line.size();) {
    const std::size_t first = line.find_first_not_of(" \t", begin);
    if (first == std::string_view::npos) return false;
    if (line[first] == '"' && line.find('"', first + 1) == std::string_view::npos) return true;
    begin = end_of_field(line, begin, separator) + 1;
  }
  return false;
}

bool is_remark(std::string_view line, char separator) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) return false;
  line.remove_prefix(first);
  return line[0] == '#' || line[0] == '%' || line.starts_with("//") ||
         (line[0] == ';' && separator != ';');
}

Result<CsvLayout> infer_layout(std::string_view head, bool is_whole_text) {
  if (is_blank(head) && is_whole_text)
    return Error{Errc::too_few_samples, "is empty: expected a table of numbers"};
  if (looks_binary(head))
    return Error{Errc::corrupt,
                 "is binary, and no format that is known: expected a table of text, or a format "
                 "that docs/formats.md lists"};
  CsvLayout layout;
  if (head.find('\n') == std::string_view::npos && head.find('\r') != std::string_view::npos)
    layout.line_end = '\r';
  const auto lines = complete_lines(head, layout.line_end, is_whole_text);
  const auto given = lines.empty() ? std::nullopt : separator_line(lines.front().text);
  const Trial trial = best_trial(lines, sample_of(lines), given);
  if (trial.width > most_columns)
    return Error{Errc::corrupt,
                 "has more than " + std::to_string(most_columns) + " columns: no table"};
  layout.separator = trial.separator;
  layout.point = trial.point;
  layout.is_grouped = trial.is_grouped;
  layout.trailing_separator = trial.trailing;
  for (const Tally& tally : trial.tallies) layout.columns.push_back(tally.kind());
  if (!place_rows(lines, layout))
    return Error{
        Errc::too_few_samples,
        "no row of numbers in its first " + std::to_string(lines.size()) +
            " lines: expected a table, columns separated by comma, semicolon, tab or blank"};
  return layout;
}

}  // namespace proofmass::io
