#include "proofmass/io/csv/dialect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/io/cell.hpp"
#include "proofmass/io/clock_text.hpp"
#include "proofmass/io/decimal.hpp"

namespace proofmass::io {
namespace {

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

}  // namespace

bool is_blank(std::string_view line) {
  return line.find_first_not_of(std::string_view(" \t\r\0", 4)) == std::string_view::npos;
}

std::size_t width_of(const std::vector<std::string_view>& fields) {
  const bool trailing = fields.size() > 1 && trimmed(fields.back()).empty();
  return fields.size() - (trailing ? 1 : 0);
}

Dialect find_dialect(const std::vector<Line>& lines, std::optional<char> given) {
  const Trial best = best_trial(lines, sample_of(lines), given);
  Dialect dialect{best.separator, best.point, best.is_grouped, best.width, best.trailing, {}};
  for (const Tally& tally : best.tallies) dialect.columns.push_back(tally.kind());
  return dialect;
}

}  // namespace proofmass::io
