#include "proofmass/io/lvm/segments.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "proofmass/io/lvm/table.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::lvm {
namespace {

/// Reads a file sequentially.
class Lister {
 public:
  Lister(const RandomBytes& file, const Progress& progress)
      : file_(file), progress_(progress), lines_(file, 0, 1) {}

  Result<Contents> run() {
    auto header = read_file_header(lines_);
    if (!header) return header.error();
    contents_.file = std::move(header).value();
    if (const Status listed = list(); !listed) return listed.error();
    if (contents_.tables.empty())
      return Error{Errc::corrupt,
                   fmt::format("line {}: no segment of figures: expected the tags of "
                               "one (Channels, Samples, …) and rows",
                               lines_.number())};
    name_tables();
    report();
    return std::move(contents_);
  }

 private:
  Status list() {
    for (std::size_t k = 0;; ++k) {
      const auto there = lines_.next();
      if (!there) return there.error();
      if (!*there) return Done{};
      if (progress_ && k % 65'536 == 0) progress_("looking for segments", fraction());
      const std::string_view line = lines_.text();
      if (is_row(line)) {
        add_row();
      } else if (const Status read = read_other(line); !read) {
        return read;
      }
    }
  }

  [[nodiscard]] double fraction() const {
    return static_cast<double>(lines_.offset()) / static_cast<double>(file_.size());
  }

  /// A line that is not a row.
  Status read_other(std::string_view line) {
    if (is_mark(line, "Start_Special")) return skip_special();
    if (line.starts_with("LabVIEW Measurement")) {
      const auto again = read_file_header(lines_);
      return again ? Status(Done{}) : note_cut("header");
    }
    if (is_tag(line)) return read_segment();
    if (line.find_first_not_of(" \t,;") != std::string_view::npos &&
        !is_mark(line, "End_of_Header"))
      pass_over();
    return Done{};
  }

  Status note_cut(std::string_view what) {
    contents_.notes.push_back(
        {Severity::bad, fmt::format("line {}: breaks off within a {}: what follows the last whole "
                                    "one is lost",
                                    lines_.number(), what)});
    return Done{};
  }

  Status skip_special() {
    const std::size_t first_line = lines_.number();
    std::string kind;
    for (;;) {
      const auto there = lines_.next();
      if (!there) return there.error();
      if (!*there) {
        contents_.notes.push_back({Severity::bad, fmt::format("line {}: a special block begins and "
                                                              "never ends: the rest is skipped",
                                                              first_line)});
        return Done{};
      }
      if (is_mark(lines_.text(), "End_Special")) break;
      if (kind.empty()) kind = shown(lines_.text());
    }
    if (specials_.size() < 16) ++specials_[kind.empty() ? "empty" : kind];
    return Done{};
  }

  Status read_segment() {
    SegmentHeader header(contents_.file);
    while (!is_mark(lines_.text(), "End_of_Header")) {
      if (is_mark(lines_.text(), "Start_Special")) {
        if (const Status skipped = skip_special(); !skipped) return skipped;
      } else {
        header.add(lines_.text());
      }
      const auto there = lines_.next();
      if (!there) return there.error();
      if (!*there) return note_cut("segment's header");
    }
    const auto there = lines_.next();
    if (!there) return there.error();
    if (!*there) return note_cut("segment's header");
    // Column names are usually present, but not always.
    const bool is_nameless = is_row(lines_.text());
    begin_segment(header.finish(is_nameless ? std::string_view{} : lines_.text()));
    if (is_nameless) add_row();
    return Done{};
  }

  void begin_segment(const Segment& segment) {
    ++segments_;
    end_segment();
    current_.clear();
    is_begun_ = false;
    pending_ = tables_of(segment, contents_.file.x);
  }

  /// Handles a segment that claims samples and has none.
  void end_segment() {
    if (pending_.empty() || pending_.front().channels.front().samples == 0) return;
    if (++empty_segments_ == 1) first_empty_line_ = lines_.number();
  }

  /// Adds a row to the tables of the last header.
  void add_row() {
    if (!is_begun_) place_pending();
    for (const std::size_t table : current_) ++contents_.tables[table].segments.back().count;
    if (current_.empty()) pass_over();
  }

  void place_pending() {
    is_begun_ = true;
    for (Table& group : pending_) {
      const Channel& first = group.channels.front();
      Rows rows{lines_.offset(),
                lines_.number(),
                0,
                0,
                {first.start_ns, first.x0, first.delta_x, first.delta_half_unit}};
      for (const Channel& channel : group.channels)
        rows.claimed = std::max(rows.claimed, channel.samples);
      const auto [same, is_new] = known_.emplace(key_of(group), contents_.tables.size());
      if (is_new) {
        group.name = fmt::format("segment {}", segments_) + group.name;
        contents_.tables.push_back(std::move(group));
      }
      contents_.tables[same->second].segments.push_back(rows);
      current_.push_back(same->second);
    }
    pending_.clear();
  }

  /// The properties that tables must share to be one.
  static std::string key_of(const Table& table) {
    std::string key;
    for (const Channel& channel : table.channels)
      key += fmt::format("{}\t{}\n", channel.column, channel.heading);
    return key;
  }

  void pass_over() {
    if (++strange_lines_ == 1) first_strange_line_ = lines_.number();
  }

  /// If the header does not state it, the decimal mark is that of the first row.
  bool is_row(std::string_view line) {
    File& file = contents_.file;
    if (file.point_is_stated) return is_data_row(line, file);
    const bool may_be_comma = file.separator != ',' && line.find(',') != std::string_view::npos &&
                              line.find('.') == std::string_view::npos;
    file.point = may_be_comma ? ',' : '.';
    file.point_is_stated = is_data_row(line, file);
    return file.point_is_stated;
  }

  /// Gives the tables distinct names, if there are several.
  void name_tables() {
    std::map<std::string, std::size_t> used;
    if (contents_.tables.size() == 1) contents_.tables[0].name.clear();
    for (Table& table : contents_.tables) {
      const std::size_t times = ++used[table.name];
      if (times > 1) table.name += fmt::format(" ({})", times);
    }
  }

  void report() {
    std::vector<Note>& notes = contents_.notes;
    if (!contents_.file.texts.empty())
      notes.insert(notes.begin(), {Severity::info, "the file says: " + contents_.file.texts});
    std::string kinds;
    for (const auto& [kind, count] : specials_)
      kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : ", ", kind, times(count));
    if (!kinds.empty()) notes.push_back({Severity::info, "special blocks skipped: " + kinds});
    if (strange_lines_ > 0)
      notes.push_back(
          {Severity::warning,
           fmt::format("{} lines are not rows of numbers, the first is line {}: skipped",
                       strange_lines_, first_strange_line_)});
    end_segment();
    if (empty_segments_ > 0)
      notes.push_back(
          {Severity::bad,
           fmt::format(
               "line {}: a segment's header is there without its rows{}", first_empty_line_,
               empty_segments_ > 1 ? fmt::format(", {} times in all", empty_segments_) : "")});
  }

  const RandomBytes& file_;
  const Progress& progress_;
  LineReader lines_;
  Contents contents_;
  std::size_t segments_ = 0;
  std::vector<Table> pending_;        ///< announced, without a row so far
  std::vector<std::size_t> current_;  ///< tables of the current rows
  bool is_begun_ = false;
  std::map<std::string, std::size_t> specials_;
  std::map<std::string, std::size_t> known_;  ///< index of a table by its properties
  std::size_t strange_lines_ = 0;
  std::size_t first_strange_line_ = 0;
  std::size_t empty_segments_ = 0;
  std::size_t first_empty_line_ = 0;
};

}  // namespace

Result<Contents> list_segments(const RandomBytes& file, const Progress& progress) {
  return Lister(file, progress).run();
}

}  // namespace proofmass::io::lvm
