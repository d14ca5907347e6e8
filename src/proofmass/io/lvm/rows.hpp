#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/io/lvm/segments.hpp"
#include "proofmass/io/stamp_reader.hpp"
#include "proofmass/io/text/line_reader.hpp"

namespace proofmass::io::lvm {

/// Faults of the rows.
struct Faults {
  std::size_t comments = 0;
  std::size_t comment_line = 0;  ///< line of the first
  std::string comment;           ///< text of the first
  std::size_t words = 0;         ///< words instead of numbers
  std::size_t word_line = 0;
  std::string word;
  std::size_t other_x = 0;  ///< rows in which the channels have different X values
  std::size_t other_x_line = 0;
  std::optional<std::size_t> cut_line;  ///< the file is truncated within it
};

/// Parses the rows of a table, segment by segment.
class RowParser {
 public:
  /// `file` and `table` must outlive the parser.
  RowParser(const RandomBytes& bytes, const File& file, const Table& table);

  /// The first X value, exact; nullopt if there is none.
  [[nodiscard]] const std::optional<StampOrigin>& first_x() const { return stamps_.origin(); }
  /// Decimals of the numbers in the first row.
  [[nodiscard]] int decimals() const { return decimals_.value_or(0); }

  /// Starts a segment, whose rows row() then reads.
  void begin(const Rows& segment);
  /// Reads a row: values of the channels, and X minus the first, NaN where missing; false at the
  /// end of the file. Errors: corrupt, unreadable.
  [[nodiscard]] Result<bool> row(std::span<double> figures, double& x);

  /// Clears the faults; the first X value is kept.
  void forget() { faults_ = {}; }
  [[nodiscard]] const Faults& faults() const { return faults_; }
  [[nodiscard]] std::uint64_t offset() const { return lines_ ? lines_->offset() : 0; }

 private:
  /// State of a row while it is read.
  struct Row {
    std::string_view x;
    std::string_view last;    ///< last number present
    std::size_t figures = 0;  ///< number of values up to that one
    bool has_other_x = false;
  };
  enum : int { skipped = -1, x_value = -2, further_x = -3, comment = -4 };

  void parse(std::string_view line, std::span<double> figures, double& x);
  const char* parse_figure(const char* begin, const char* end, double& figure);
  double read_figure(std::string_view field);
  [[nodiscard]] const char* end_of_field(const char* begin, const char* end) const;
  void take_field(int use, std::string_view field, Row& row);
  void take_comment(std::string_view field);
  void judge(const Row& row, std::span<double> figures);

  const RandomBytes& bytes_;
  const File& file_;
  const Table& table_;
  std::vector<int> uses_;  ///< per file column: the channel, or one of the above
  std::unique_ptr<LineReader> lines_;
  StampReader stamps_;
  std::optional<int> decimals_;
  Faults faults_;
};

}  // namespace proofmass::io::lvm
