#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"

namespace proofmass::io {

/// A text column as runs of equal words, built row by row. Abandoned, keeping nothing, if the words
/// cannot be names: more than most_names of them, more than most_runs runs, or one of more than
/// longest_name bytes. Memory: that of the runs.
class WordRuns {
 public:
  static constexpr std::size_t most_names = 256;
  static constexpr std::size_t most_runs = std::size_t{1} << 16;
  static constexpr std::size_t longest_name = 100;

  /// The field of a row, including blanks and quotes; rows ascend. A skipped row, an empty field
  /// and a word for missing ("nan", "-", "none") end the run.
  void add(std::size_t row, std::string_view field) {
    if (given_up_) return;
    if (field == field_ && row == last_row_ + 1) {
      last_row_ = row;
      if (name_) runs_.back().last = row;
      return;
    }
    change(row, field);
  }

  [[nodiscard]] std::size_t runs() const { return runs_.size(); }
  [[nodiscard]] std::size_t names() const { return names_.size(); }
  /// True if it has more than one word over all `rows` rows.
  [[nodiscard]] bool changes(std::size_t rows) const;
  [[nodiscard]] std::vector<Label> labels() const;

 private:
  struct Run {
    std::size_t name = 0;
    std::size_t first = 0;
    std::size_t last = 0;
  };

  void change(std::size_t row, std::string_view field);
  void give_up();

  std::vector<std::string> names_;
  std::vector<Run> runs_;
  std::string field_;                ///< field of the previous row, as read
  std::optional<std::size_t> name_;  ///< its word, if any
  std::size_t last_row_ = 0;
  bool given_up_ = false;
};

}  // namespace proofmass::io
