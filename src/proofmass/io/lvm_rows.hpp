#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/io/line_reader.hpp"
#include "proofmass/io/lvm_segments.hpp"
#include "proofmass/io/stamp_reader.hpp"

namespace proofmass::io {

/// What was odd about the rows.
struct LvmFaults {
  std::size_t comments = 0;
  std::size_t comment_line = 0;  ///< of the first
  std::string comment;           ///< the first
  std::size_t words = 0;         ///< where a figure belongs
  std::size_t word_line = 0;
  std::string word;
  std::size_t other_x = 0;  ///< rows in which the channels have X values that differ
  std::size_t other_x_line = 0;
  std::optional<std::size_t> cut_line;  ///< the file breaks off within it
};

/// Parses the rows of a table, segment by segment.
class LvmRowParser {
 public:
  /// `file` and `table` must outlive the parser.
  LvmRowParser(const RandomBytes& bytes, const LvmFile& file, const LvmTable& table);

  /// The first X value that there is, exact; nullopt where there is none.
  [[nodiscard]] const std::optional<StampOrigin>& first_x() const { return stamps_.origin(); }
  /// Decimals of the figures in the first row.
  [[nodiscard]] int decimals() const { return decimals_.value_or(0); }

  /// Goes to a segment. Then row() reads one after another.
  void begin(const LvmRows& segment);
  /// Reads a row: figures of the channels, and X less the first, NaN where there is none; false if
  /// the file ends. Errors: corrupt, unreadable.
  [[nodiscard]] Result<bool> row(std::span<double> figures, double& x);

  /// Forgets what was odd so far; the first X value stays.
  void forget() { faults_ = {}; }
  [[nodiscard]] const LvmFaults& faults() const { return faults_; }
  [[nodiscard]] std::uint64_t offset() const { return lines_ ? lines_->offset() : 0; }

 private:
  /// What is seen of a row while it is read.
  struct Row {
    std::string_view x;
    std::string_view last;    ///< figure that is there
    std::size_t figures = 0;  ///< up to that one
    bool has_other_x = false;
  };
  enum : int { passed_over = -1, x_value = -2, further_x = -3, comment = -4 };

  void parse(std::string_view line, std::span<double> figures, double& x);
  const char* parse_figure(const char* begin, const char* end, double& figure);
  double read_figure(std::string_view field);
  [[nodiscard]] const char* end_of_field(const char* begin, const char* end) const;
  void take_field(int use, std::string_view field, Row& row);
  void take_comment(std::string_view field);
  void judge(const Row& row, std::span<double> figures);

  const RandomBytes& bytes_;
  const LvmFile& file_;
  const LvmTable& table_;
  std::vector<int> uses_;  ///< of each column of the file: the channel, or one of the above
  std::unique_ptr<LineReader> lines_;
  StampReader stamps_;
  std::optional<int> decimals_;
  LvmFaults faults_;
};

}  // namespace proofmass::io
