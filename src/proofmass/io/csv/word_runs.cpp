#include "proofmass/io/csv/word_runs.hpp"

#include <algorithm>

#include "proofmass/io/cell.hpp"

namespace proofmass::io {

bool WordRuns::changes(std::size_t rows) const {
  return runs_.size() > 1 ||
         (runs_.size() == 1 && (runs_[0].first > 0 || runs_[0].last + 1 < rows));
}

std::vector<Label> WordRuns::labels() const {
  std::vector<Label> labels;
  labels.reserve(runs_.size());
  for (const Run& run : runs_) labels.push_back({names_[run.name], run.first, run.last});
  return labels;
}

void WordRuns::change(std::size_t row, std::string_view field) {
  const bool follows = row == last_row_ + 1;
  const auto before = name_;
  last_row_ = row;
  field_ = field;
  name_.reset();
  const std::string_view word = without_guard(trimmed(field));
  if (word.size() > longest_name) return give_up();
  if (read_cell(field, '.').kind == CellKind::missing) return;
  const auto at = static_cast<std::size_t>(std::ranges::find(names_, word) - names_.begin());
  if (at == names_.size()) names_.emplace_back(word);
  name_ = at;
  if (follows && before == name_) {
    runs_.back().last = row;
    return;
  }
  runs_.push_back({at, row, row});
  if (names_.size() > most_names || runs_.size() > most_runs) give_up();
}

void WordRuns::give_up() {
  *this = {};
  given_up_ = true;
}

}  // namespace proofmass::io
