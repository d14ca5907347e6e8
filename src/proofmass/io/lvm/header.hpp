#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/io/text/line_reader.hpp"

namespace proofmass::io::lvm {

/// Columns of X values in a file.
enum class XColumns { no, one, multi };

/// Header of the file.
struct File {
  char separator = '\t';
  char point = '.';
  bool point_is_stated = false;
  XColumns x = XColumns::one;
  bool is_absolute = false;  ///< X values count from 1904, if they are that large
  std::string texts;         ///< "Operator JS, Project …"
};

/// A channel of a segment.
struct Channel {
  std::string heading;           ///< with the unit, if known
  std::size_t column = 0;        ///< column of its values
  std::string delta_text;        ///< Delta_X as written
  double delta_x = 0.0;          ///< 0: not given
  double delta_half_unit = 0.0;  ///< half a unit in its last written digit
  double x0 = 0.0;
  std::size_t samples = 0;  ///< according to the header; 0: not given
  std::optional<std::int64_t> start_ns;

  /// True if two channels have the same heading and column.
  [[nodiscard]] bool is_same(const Channel& other) const {
    return heading == other.heading && column == other.column;
  }
};

/// Header of a segment.
struct Segment {
  std::vector<Channel> channels;
  bool x_is_time = true;
  std::string x_heading;  ///< heading of X, if that is not time
  std::vector<Note> notes;
};

/// True if a line belongs to the header of the file or of a segment: it begins with one of their
/// tags.
[[nodiscard]] bool is_tag(std::string_view line);
/// True if a line begins with the mark "***<word>***".
[[nodiscard]] bool is_mark(std::string_view line, std::string_view word);

/// Reads the file's header up to its end mark; `lines` is positioned before its first line. Errors:
/// corrupt (it has no end), unreadable.
[[nodiscard]] Result<File> read_file_header(LineReader& lines);

/// The header of a segment, line by line.
class SegmentHeader {
 public:
  explicit SegmentHeader(const File& file) : file_(file) {}

  void add(std::string_view line);
  /// The header, once the line of column names was read, which may be empty.
  [[nodiscard]] Segment finish(std::string_view names);

 private:
  [[nodiscard]] std::vector<std::string> fields_of(std::string_view line) const;
  [[nodiscard]] std::size_t count_channels() const;
  [[nodiscard]] Channel channel(std::size_t index, std::vector<std::string>& unknown_units) const;

  const File& file_;
  std::size_t channels_ = 0;
  std::vector<std::string> samples_, dates_, times_, units_, dimensions_, x0_, delta_x_, names_;
  std::vector<std::string> x_units_;
  std::string texts_;
};

}  // namespace proofmass::io::lvm
