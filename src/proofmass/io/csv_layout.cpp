#include "proofmass/io/csv_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"

namespace proofmass::io {
namespace {

struct Line {
  std::string_view text;
  std::size_t offset = 0;
  std::size_t number = 1;
};

bool is_blank(std::string_view line) {
  return line.find_first_not_of(std::string_view(" \t\r\0", 4)) == std::string_view::npos;
}

/// The lines that end within the text.
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

/// "sep=;" on the first line, which spreadsheets write for one another.
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

  void add(std::string_view field, char point) {
    switch (read_cell(field, point).kind) {
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
    if (text > number + clocks()) return ColumnKind::text;
    if (number >= clocks()) return ColumnKind::number;
    if (clock >= date && clock >= time_of_day) return ColumnKind::clock;
    return date > time_of_day ? ColumnKind::date : ColumnKind::time_of_day;
  }
};

/// One way of taking the sampled lines apart, and how well it does.
struct Trial {
  char separator = ',';
  char point = '.';
  std::size_t width = 0;  ///< of most lines, an empty last field not counted
  bool trailing = false;  ///< most lines of that width end in a separator
  double score = -1e300;
  std::vector<Tally> tallies;
};

std::size_t width_of(const std::vector<std::string_view>& fields) {
  const bool trailing = fields.size() > 1 && trimmed(fields.back()).empty();
  return fields.size() - (trailing ? 1 : 0);
}

/// The commonest width, the larger of two that are equally common.
std::size_t commonest(const std::vector<std::size_t>& widths) {
  std::map<std::size_t, std::size_t> counts;
  for (const std::size_t width : widths) ++counts[width];
  std::size_t best = 0;
  for (const auto& [width, count] : counts)
    if (best == 0 || count >= counts[best]) best = width;
  return best;
}

/// Scores the rows, and settles what the columns are by the last half of them: a header of several
/// lines may outnumber the rows of a short file.
void tally_columns(const std::vector<std::vector<std::string_view>>& rows, Trial& trial) {
  std::vector<Tally> all(trial.width);
  trial.tallies.assign(trial.width, {});
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < trial.width; ++c) {
      all[c].add(rows[r][c], trial.point);
      if (r >= rows.size() / 2) trial.tallies[c].add(rows[r][c], trial.point);
    }
  }
  for (const Tally& tally : all)
    trial.score +=
        static_cast<double>(tally.number + tally.clocks()) - 1.5 * static_cast<double>(tally.text);
}

Trial attempt(const std::vector<Line>& sample, char separator, char point) {
  Trial trial{separator, point, 0, false, 0.0, {}};
  std::vector<std::vector<std::string_view>> split;
  std::vector<std::size_t> widths;
  for (const Line& line : sample) {
    if (is_remark(line.text, separator)) continue;
    split_fields(line.text, separator, split.emplace_back());
    widths.push_back(width_of(split.back()));
  }
  trial.width = std::min(commonest(widths), most_columns + 1);
  const std::size_t lines = split.size();
  std::erase_if(split, [&](const auto& fields) { return width_of(fields) != trial.width; });
  trial.score = -static_cast<double>(lines - split.size());
  const auto trailing =
      std::ranges::count_if(split, [&](const auto& fields) { return fields.size() > trial.width; });
  trial.trailing = 2 * static_cast<std::size_t>(trailing) > split.size();
  tally_columns(split, trial);
  return trial;
}

/// "0,5" below one name is half, not two columns: a header one field wide settles it.
bool header_is_one_wide(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    if (is_blank(line.text) || is_remark(line.text, ',')) continue;
    if (line.text.find(',') == std::string_view::npos) return true;
    return false;
  }
  return false;
}

Trial best_trial(const std::vector<Line>& lines,
                 const std::vector<Line>& sample,
                 std::optional<char> given) {
  constexpr std::array<char, 5> separators{',', ';', '\t', '|', ' '};
  Trial best;
  for (const char point : {'.', ','}) {
    for (const char separator : separators) {
      if (separator == point || (given && separator != *given)) continue;
      Trial trial = attempt(sample, separator, point);
      // A comma in a line without any separator is one, but for the exception below.
      if (point == ',' && trial.width < 2) continue;
      if (trial.score > best.score) best = std::move(trial);
    }
  }
  if (given && best.width == 0) best = attempt(sample, *given, '.');
  if (!given && best.separator == ',' && best.width == 2 && header_is_one_wide(lines)) {
    Trial halves = attempt(sample, ';', ',');
    if (halves.width == 1 && halves.score > 0.0) best = std::move(halves);
  }
  return best;
}

/// Lines to judge by: the last of those looked at, which are rows whatever precedes them.
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
    const CellKind kind = read_cell(fields[c], layout.point).kind;
    const bool stands_for_value = layout.columns[c] == ColumnKind::number
                                      ? kind == CellKind::number
                                      : read_clock(fields[c]).has_value();
    if (kind == CellKind::text && !stands_for_value) return false;
    any = any || stands_for_value;
  }
  return any;
}

/// The text of a remark without its mark.
std::string without_mark(std::string_view line) {
  const auto first = line.find_first_not_of(" \t#%;/");
  return std::string(first == std::string_view::npos ? std::string_view{} : line.substr(first));
}

/// Ascending over what is looked at, but for one in ten.
bool first_column_ascends(const std::vector<Line>& rows, const CsvLayout& layout) {
  if (layout.columns.empty() || layout.columns[0] != ColumnKind::number) return false;
  std::vector<std::string_view> fields;
  std::size_t up = 0;
  std::size_t steps = 0;
  double last = std::nan("");
  for (const Line& row : rows) {
    split_fields(row.text, layout.separator, fields);
    const double value = read_cell(fields.front(), layout.point).value;
    if (!std::isnan(last) && !std::isnan(value)) {
      ++steps;
      if (value > last) ++up;
    }
    last = value;
  }
  return steps >= 2 && up * 10 >= steps * 9;
}

bool looks_binary(std::string_view head) {
  const auto odd = std::ranges::count_if(head, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 32 && c != '\t' && c != '\n' && c != '\r' && c != '\0' && c != '\f' &&
           c != '\x1A';
  });
  return static_cast<std::size_t>(odd) * 50 > head.size();
}

/// Fills in where the rows begin and what stands before them; false if there is no row.
bool find_first_row(const std::vector<Line>& lines, CsvLayout& layout) {
  std::vector<std::string_view> fields;
  std::vector<Line> rows;
  for (const Line& line : lines) {
    if (is_blank(line.text)) continue;
    const bool remark = is_remark(line.text, layout.separator);
    bool row = false;
    if (!remark) {
      split_fields(line.text, layout.separator, fields);
      row = is_row(fields, layout);
    }
    if (row) {
      if (rows.empty()) {
        layout.data_offset = line.offset;
        layout.first_line = line.number;
      }
      rows.push_back(line);
    } else if (rows.empty() && !(line.number == 1 && separator_line(line.text))) {
      layout.preamble.push_back(
          {line.number, remark, remark ? without_mark(line.text) : std::string(line.text)});
    }
  }
  if (rows.empty()) return false;
  std::size_t bytes = 0;
  for (const Line& row : rows) bytes += row.text.size() + 1;
  layout.bytes_per_row = static_cast<double>(bytes) / static_cast<double>(rows.size());
  layout.first_ascends = first_column_ascends(rows, layout);
  return true;
}

}  // namespace

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool blanks = separator == ' ';
  const auto separates = [&](char c) { return c == separator || (blanks && c == '\t'); };
  std::size_t i = 0;
  const auto skip_blanks = [&] {
    while (i < line.size() && separates(line[i])) ++i;
  };
  if (blanks) skip_blanks();
  std::size_t begin = i;
  for (; i < line.size(); ++i) {
    if (line[i] == '"' && trimmed(line.substr(begin, i - begin)).empty()) {
      const std::size_t close = line.find('"', i + 1);
      if (close != std::string_view::npos) i = close;
      continue;
    }
    if (!separates(line[i])) continue;
    fields.push_back(line.substr(begin, i - begin));
    if (fields.size() > most_columns) return;
    begin = i + 1;
    if (!blanks) continue;
    skip_blanks();
    begin = i;
    if (i == line.size()) return;
    --i;
  }
  fields.push_back(line.substr(std::min(begin, line.size())));
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
    return Error{Errc::corrupt, "is binary, and no format that is known: expected CSV or .npy"};
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
  layout.trailing_separator = trial.trailing;
  for (const Tally& tally : trial.tallies) layout.columns.push_back(tally.kind());
  if (!find_first_row(lines, layout))
    return Error{
        Errc::too_few_samples,
        "no row of numbers in its first " + std::to_string(lines.size()) +
            " lines: expected a table, columns separated by comma, semicolon, tab or blank"};
  return layout;
}

}  // namespace proofmass::io
