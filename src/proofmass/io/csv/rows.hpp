#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/csv/layout.hpp"
#include "proofmass/io/csv/word_runs.hpp"
#include "proofmass/io/reading/columns.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// Use of a column.
enum class ColumnUse : unsigned char { keep, stamps, words, skip };

/// Number of occurrences, and the first one.
struct Seen {
  std::size_t count = 0;
  std::size_t first_line = 0;
  void add(std::size_t line) {
    if (count++ == 0) first_line = line;
  }
};

/// Faults of the rows; none of them stops the reading.
struct RowFaults {
  Seen narrow;                        ///< fewer fields than columns: the missing ones are NaN
  Seen wide;                          ///< more fields than columns: the excess is ignored
  Seen unreadable;                    ///< no number in it: skipped
  Seen cut;                           ///< truncated: its last field is NaN
  Seen nul;                           ///< contains zero bytes
  std::map<std::size_t, Seen> words;  ///< by column: a word instead of a number
  std::map<std::size_t, std::string> first_word;
  std::map<std::size_t, Seen> grouped;  ///< by column: numbers with separated thousands
  std::map<std::size_t, std::string> first_grouped;
  Seen remarks;  ///< comments between the rows
  /// Lines between the rows that are not samples: then lines and samples do not advance together.
  bool out_of_step = false;
};

/// Converts lines of a known layout to columns of doubles.
class CsvRows {
 public:
  /// The layout must outlive the rows; `uses` gives the use of each column.
  CsvRows(const CsvLayout& layout,
          std::vector<ColumnUse> uses,
          std::optional<StampReader> stamps,
          std::optional<std::size_t> date_column,
          std::size_t expected_rows);

  /// Parses whole lines, each terminated by the layout's line end, with decimal_padding readable
  /// bytes after `end`.
  void parse(const char* begin, const char* end);
  /// Parses the last line of the text, without its line end.
  void parse_last(std::string_view line);
  /// Appends the rows gathered by parse() to the columns; call before taking them.
  void flush();

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] const RowFaults& faults() const { return faults_; }
  /// Lines between the rows with as many fields as columns and no number: the first few, which
  /// include a second header if there is one.
  [[nodiscard]] const std::vector<PreambleLine>& wordy_lines() const { return wordy_lines_; }
  [[nodiscard]] const std::optional<StampReader>& stamps() const { return stamps_; }
  /// The values of the file's column c, which must be kept or stamps, since the last call; after
  /// flush().
  [[nodiscard]] std::vector<double> take(std::size_t column);
  /// The words of the text columns, and of columns that were empty in the layout.
  [[nodiscard]] const std::map<std::size_t, WordRuns>& words() const { return words_; }

 private:
  template <bool BlankSeparated>
  const char* parse_plain(const char* p);
  template <bool BlankSeparated>
  void parse_lines(const char* begin, const char* end);
  const char* end_of_row(const char* begin, const char* end);
  void parse_any(std::string_view line, bool is_cut);
  void parse_fields(std::string_view line, bool is_cut);
  const char* parse_words(const char* begin, std::size_t column);
  void read_row(std::size_t count);
  std::size_t usable_fields(bool is_cut);
  [[nodiscard]] bool is_figure(std::size_t column) const;
  double read_field(std::size_t column, std::size_t fields);
  void note_grouping(std::size_t column);
  void commit();
  void commit_words();

  static constexpr std::size_t most_wordy_lines = 64;
  static constexpr std::size_t block = 512;  ///< rows gathered before they are appended to columns

  const CsvLayout& layout_;
  std::vector<ColumnUse> uses_;
  std::optional<StampReader> stamps_;
  std::optional<std::size_t> date_column_;
  std::vector<std::size_t> slots_;  ///< index of each file column among those of its use
  std::vector<GrowingColumn> columns_;
  std::vector<double> gathered_;  ///< in blocks, each column's rows contiguous
  std::size_t gathered_rows_ = 0;
  std::size_t rows_ = 0;
  std::size_t line_ = 0;
  std::vector<std::string_view> fields_;
  std::map<std::size_t, WordRuns> words_;
  // Destination and value of the row's word, for each text column.
  std::vector<WordRuns*> word_runs_;
  std::vector<std::string_view> row_words_;
  bool pending_gap_ = false;  ///< a line that is not a sample; relevant only if a sample follows
  bool plain_ = true;         ///< no calendar time: parse_plain may be tried
  RowFaults faults_;
  std::vector<PreambleLine> wordy_lines_;
};

}  // namespace proofmass::io
