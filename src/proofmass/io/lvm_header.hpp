#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/line_reader.hpp"

namespace proofmass::io {

/// Which columns of X values a file has.
enum class LvmX { no, one, multi };

/// What stands before all segments.
struct LvmFile {
  char separator = '\t';
  char point = '.';
  bool point_is_told = false;
  LvmX x = LvmX::one;
  bool is_absolute = false;  ///< X values count from 1904, if they are that large
  std::string texts;         ///< "Operator JS, Project …"
};

/// A channel of a segment.
struct LvmChannel {
  std::string heading;           ///< unit included, if it is known
  std::size_t column = 0;        ///< of its figures
  std::string delta_text;        ///< Delta_X as written
  double delta_x = 0.0;          ///< 0: not told
  double delta_half_unit = 0.0;  ///< half a unit in the last place that it is written with
  double x0 = 0.0;
  std::size_t samples = 0;  ///< as the header says; 0: not told
  std::optional<std::int64_t> start_ns;

  /// Whether two channels have one heading in one column.
  [[nodiscard]] bool is_same(const LvmChannel& other) const {
    return heading == other.heading && column == other.column;
  }
};

/// What stands before the rows of a segment.
struct LvmSegment {
  std::vector<LvmChannel> channels;
  bool x_is_time = true;
  std::string x_heading;  ///< where it is not
  std::vector<Note> notes;
};

/// Whether a line is one of the file's or a segment's header: it begins with one of their tags.
[[nodiscard]] bool is_lvm_tag(std::string_view line);
/// Whether a line is the mark "***<word>***", whatever stands behind it.
[[nodiscard]] bool is_lvm_mark(std::string_view line, std::string_view word);

/// Reads the file's header up to its end mark, `lines` standing before its first line.
/// Errors: corrupt (it has no end), unreadable.
[[nodiscard]] Result<LvmFile> read_lvm_file_header(LineReader& lines);

/// The header of a segment, line by line.
class LvmSegmentHeader {
 public:
  explicit LvmSegmentHeader(const LvmFile& file) : file_(file) {}

  void add(std::string_view line);
  /// All there is once the line of column names was read, which may be empty.
  [[nodiscard]] LvmSegment finish(std::string_view names);

 private:
  [[nodiscard]] std::vector<std::string> fields_of(std::string_view line) const;
  [[nodiscard]] std::size_t count_channels() const;
  [[nodiscard]] LvmChannel channel(std::size_t index,
                                   std::vector<std::string>& unknown_units) const;

  const LvmFile& file_;
  std::size_t channels_ = 0;
  std::vector<std::string> samples_, dates_, times_, units_, dimensions_, x0_, delta_x_, names_;
  std::vector<std::string> x_units_;
  std::string texts_;
};

}  // namespace proofmass::io
