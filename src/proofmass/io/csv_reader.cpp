#include "proofmass/io/csv_reader.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <iterator>

#include "proofmass/io/csv_columns.hpp"
#include "proofmass/io/csv_notes.hpp"
#include "proofmass/io/finish_recording.hpp"

namespace proofmass::io {
namespace {

/// Lines longer than this belong to no table.
constexpr std::size_t longest_line = std::size_t{8} << 20;

/// The beginning of the text: 64 KiB, or more if that does not hold ten lines.
Result<std::string_view> peek_head(PeekSource& source) {
  for (std::size_t wanted = std::size_t{64} << 10;; wanted *= 4) {
    const auto head = source.peek(wanted);
    if (!head) return head.error();
    const bool whole = head->size() < wanted;
    const auto lines = std::ranges::count_if(*head, [](char c) { return c == '\n' || c == '\r'; });
    if (whole || lines >= 10 || wanted >= longest_line) return *head;
  }
}

std::size_t expected_rows(const PeekSource& source, const CsvLayout& layout) {
  if (!source.size() || layout.bytes_per_row <= 0.0) return 0;
  // Half as many again as the first rows promise: what is reserved and not used costs nothing.
  const double rows = 1.5 * static_cast<double>(*source.size()) / layout.bytes_per_row + 64.0;
  constexpr double most_values = 1 << 30;
  return static_cast<std::size_t>(
      std::min(rows, most_values / static_cast<double>(layout.columns.size())));
}

/// Feeds the text from the first row on to `rows`, a piece at a time.
class LineFeed {
 public:
  LineFeed(PeekSource& source, CsvRows& rows, const CsvLayout& layout, const Progress& progress)
      : source_(source), rows_(rows), layout_(layout), progress_(progress) {}

  Status run() {
    std::size_t to_skip = layout_.data_offset;
    for (;;) {
      if (filled_ == buffer_.size() - decimal_padding && !make_room())
        return Error{Errc::corrupt, fmt::format("line {}: longer than {} MiB: no table",
                                                rows_.line(), longest_line >> 20)};
      const auto count = source_.read(
          std::span(buffer_).subspan(filled_, buffer_.size() - decimal_padding - filled_));
      if (!count) return count.error().at(fmt::format("line {}", rows_.line()));
      if (*count == 0) break;
      filled_ += *count;
      const std::size_t skipped = std::min(to_skip, filled_);
      if (skipped > 0) drop_front(skipped);
      to_skip -= skipped;
      parse_whole_lines();
      if (progress_) progress_("reading", source_.fraction_read());
    }
    if (filled_ > 0) rows_.parse_last({buffer_.data(), filled_});
    return Done{};
  }

 private:
  void drop_front(std::size_t count) {
    std::memmove(buffer_.data(), buffer_.data() + count, filled_ - count);
    filled_ -= count;
    searched_ = 0;
  }

  /// A tail of zeros after a power cut can be of any length: all but one of them can go.
  bool make_room() {
    const auto last = std::string_view(buffer_.data(), filled_).find_last_not_of('\0');
    const std::size_t kept = last == std::string_view::npos ? 1 : last + 2;
    if (kept < filled_) {
      filled_ = kept;
      searched_ = std::min(searched_, kept);
      return true;
    }
    if (buffer_.size() > longest_line) return false;
    buffer_.resize(2 * buffer_.size());
    return true;
  }

  void parse_whole_lines() {
    const std::string_view fresh(buffer_.data() + searched_, filled_ - searched_);
    const auto last = fresh.rfind(layout_.line_end);
    if (last == std::string_view::npos) {
      searched_ = filled_;
      return;
    }
    const std::size_t end = searched_ + last + 1;
    rows_.parse(buffer_.data(), buffer_.data() + end);
    drop_front(end);
    searched_ = filled_;
  }

  PeekSource& source_;
  CsvRows& rows_;
  const CsvLayout& layout_;
  const Progress& progress_;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{256} << 10);
  std::size_t filled_ = 0;
  std::size_t searched_ = 0;  ///< bytes known to hold no line end
};

/// The time column as it was read.
std::optional<StampColumn> take_stamps(const CsvColumns& columns,
                                       const CsvHeader& header,
                                       CsvRows& rows,
                                       std::vector<Note>& notes) {
  if (!columns.stamps) return std::nullopt;
  const ColumnLabel& label = header.labels[*columns.stamps];
  const StampReader& reader = *rows.stamps();
  StampColumn stamps{label.name, label.unit, reader.origin().value_or(StampOrigin{}), {}};
  if (columns.spelling != StampSpelling::figures) {
    stamps.unit = *parse_unit("s");
    if (reader.zone_missing())
      notes.push_back({Severity::info, label.name + ": no time zone is given: taken for UTC"});
  }
  stamps.values = rows.take(*columns.stamps);
  stamps.is_named = header.found;
  return stamps;
}

/// Whether the words of a column may be labels: it is read as words, or holds no figure at all.
bool is_all_words(std::size_t column, const CsvColumns& columns, const Recording& recording) {
  if (columns.uses[column] == ColumnUse::words) return true;
  if (columns.uses[column] != ColumnUse::keep) return false;
  const auto place =
      std::count(columns.uses.begin(), columns.uses.begin() + static_cast<std::ptrdiff_t>(column),
                 ColumnUse::keep);
  return std::ranges::all_of(recording.channels[static_cast<std::size_t>(place)].values,
                             [](double value) { return std::isnan(value); });
}

/// The first column of words that says more than one thing for all rows, else the first.
std::optional<std::size_t> label_column(const CsvColumns& columns,
                                        const CsvRows& rows,
                                        const Recording& recording) {
  std::optional<std::size_t> constant;
  for (const auto& [column, words] : rows.words()) {
    if (words.runs() == 0 || !is_all_words(column, columns, recording)) continue;
    if (words.changes(rows.rows())) return column;
    if (!constant) constant = column;
  }
  return constant;
}

/// Makes the column of words the recording's labels; it is no channel then.
void take_labels(std::size_t column,
                 CsvColumns& columns,
                 const CsvHeader& header,
                 const CsvRows& rows,
                 Recording& recording) {
  const WordRuns& words = rows.words().at(column);
  recording.labels = words.labels();
  recording.label_channel = header.labels[column].name;
  columns.labels = column;
  std::erase_if(recording.channels,
                [&](const Channel& channel) { return channel.name == recording.label_channel; });
}

}  // namespace

Result<Recording> read_csv(PeekSource& source, const ReadOptions& options) {
  const auto head = peek_head(source);
  if (!head) return head.error();
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t mark = head->starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  auto layout = infer_layout(head->substr(mark), head->size() < (std::size_t{64} << 10));
  if (!layout) return layout.error();
  CsvLayout table = *layout;
  table.data_offset += mark;
  const CsvHeader header = read_header(table);
  const auto chosen = choose_columns(table, header, options);
  if (!chosen) return chosen.error();
  CsvColumns columns = *chosen;
  if (std::ranges::count(columns.uses, ColumnUse::keep) == 0)
    return Error{Errc::too_few_samples, "has no column of numbers beside the time"};

  std::optional<StampReader> stamps;
  if (columns.stamps) stamps.emplace(columns.spelling, table.point);
  CsvRows rows(table, columns.uses, stamps, columns.date, expected_rows(source, table));
  if (const Status fed = LineFeed(source, rows, table, options.progress).run(); !fed)
    return fed.error();
  rows.finish();

  Recording recording;
  recording.format = "CSV";
  for (std::size_t c = 0; c < columns.uses.size(); ++c)
    if (columns.uses[c] == ColumnUse::keep)
      recording.channels.push_back({header.labels[c].name, header.labels[c].unit, rows.take(c)});
  if (!rows.faults().out_of_step) recording.first_line = table.first_line;
  if (const auto labels = label_column(columns, rows, recording))
    take_labels(*labels, columns, header, rows, recording);
  tell_layout(table, header, columns, recording.notes);
  tell_faults(rows.faults(), header, columns, recording.notes);
  std::ranges::move(source.notes(), std::back_inserter(recording.notes));
  auto time = take_stamps(columns, header, rows, recording.notes);
  return finish_recording(std::move(recording), std::move(time), header.rate_hz, options);
}

}  // namespace proofmass::io
