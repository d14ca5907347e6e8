#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/columns.hpp"
#include "proofmass/io/csv_layout.hpp"
#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/word_runs.hpp"

namespace proofmass::io {

/// What becomes of a column.
enum class ColumnUse : unsigned char { keep, stamps, words, skip };

/// How often something was seen, and where first.
struct Seen {
  std::size_t count = 0;
  std::size_t first_line = 0;
  void add(std::size_t line) {
    if (count++ == 0) first_line = line;
  }
};

/// What was wrong with the rows; none of it stops the reading.
struct RowFaults {
  Seen narrow;                        ///< fewer fields than columns: the missing are NaN
  Seen wide;                          ///< more fields than columns: the excess is passed over
  Seen unreadable;                    ///< no number in it at all: passed over
  Seen cut;                           ///< broke off: its last field is NaN
  Seen nul;                           ///< bytes of zero in it
  std::map<std::size_t, Seen> words;  ///< by column: a word where a number was expected
  std::map<std::size_t, std::string> first_word;
  std::map<std::size_t, Seen> grouped;  ///< by column: figures with their thousands separated
  std::map<std::size_t, std::string> first_grouped;
  Seen remarks;  ///< between the rows
  /// Lines between the rows that are no sample: then line and sample do not run in step.
  bool out_of_step = false;
};

/// Turns lines of a known layout into columns of doubles.
class CsvRows {
 public:
  /// The layout must outlive the rows; `uses` says of each of its columns what becomes of it.
  CsvRows(const CsvLayout& layout,
          std::vector<ColumnUse> uses,
          std::optional<StampReader> stamps,
          std::optional<std::size_t> date_column,
          std::size_t expected_rows);

  /// Parses whole lines, each ended by the layout's line end, with decimal_padding readable bytes
  /// behind `end`.
  void parse(const char* begin, const char* end);
  /// Parses what is left at the end of the text, without its line end.
  void parse_last(std::string_view line);
  /// Hands over what parse() has gathered to the columns, before they are taken.
  void flush();

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] const RowFaults& faults() const { return faults_; }
  /// Lines between the rows that hold as many fields as there are columns, and no figure: the first
  /// few, among which a second header will be.
  [[nodiscard]] const std::vector<PreambleLine>& wordy_lines() const { return wordy_lines_; }
  [[nodiscard]] const std::optional<StampReader>& stamps() const { return stamps_; }
  /// The values of the file's column c, which must be kept or stamps, since they were last taken;
  /// after flush().
  [[nodiscard]] std::vector<double> take(std::size_t column);
  /// The words of the file's columns that are read as words, and those in columns where the layout
  /// saw nothing at all.
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
  static constexpr std::size_t block = 512;  ///< rows gathered before columns are appended to

  const CsvLayout& layout_;
  std::vector<ColumnUse> uses_;
  std::optional<StampReader> stamps_;
  std::optional<std::size_t> date_column_;
  std::vector<std::size_t> slots_;  ///< of each column of the file among those of its kind
  std::vector<GrowingColumn> columns_;
  std::vector<double> gathered_;  ///< block by block, a column's rows side by side
  std::size_t gathered_rows_ = 0;
  std::size_t rows_ = 0;
  std::size_t line_ = 0;
  std::vector<std::string_view> fields_;
  std::map<std::size_t, WordRuns> words_;
  // Where the row's word goes, and the word, for each column of words.
  std::vector<WordRuns*> word_runs_;
  std::vector<std::string_view> row_words_;
  bool pending_gap_ = false;  ///< a line that is no sample, harmful only if a sample follows
  bool plain_ = true;         ///< no calendar time: parse_plain may be tried
  RowFaults faults_;
  std::vector<PreambleLine> wordy_lines_;
};

}  // namespace proofmass::io
