#include "proofmass/io/csv/reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <limits>

#include "proofmass/io/csv/columns.hpp"
#include "proofmass/io/csv/dense_rows.hpp"
#include "proofmass/io/csv/notes.hpp"
#include "proofmass/io/time/stamp_shift.hpp"

namespace proofmass::io {
namespace {

/// Longer lines are not part of a table.
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
  // 1.5 times the estimate from the first rows: reserved memory that is not used costs nothing.
  const double rows = 1.5 * static_cast<double>(*source.size()) / layout.bytes_per_row + 64.0;
  constexpr double most_values = 1 << 30;
  return static_cast<std::size_t>(
      std::min(rows, most_values / static_cast<double>(layout.columns.size())));
}

/// Passes the text from the first row on to `rows`, in pieces.
class LineFeed {
 public:
  LineFeed(PeekSource& source, const CsvLayout& layout)
      : source_(source), layout_(layout), to_skip_(layout.data_offset) {}

  /// Reads one piece and parses its whole lines, at the end of the text all; false at the end.
  Result<bool> step(CsvRows& rows) {
    if (at_end_) return false;
    if (filled_ == buffer_.size() - decimal_padding && !make_room())
      return Error{Errc::corrupt, fmt::format("line {}: longer than {} MiB: no table", rows.line(),
                                              longest_line >> 20)};
    const auto count = source_.read(
        std::span(buffer_).subspan(filled_, buffer_.size() - decimal_padding - filled_));
    if (!count) return count.error().at(fmt::format("line {}", rows.line()));
    if (*count == 0) {
      at_end_ = true;
      if (filled_ > 0) rows.parse_last({buffer_.data(), filled_});
      return true;
    }
    filled_ += *count;
    const std::size_t skipped = std::min(to_skip_, filled_);
    if (skipped > 0) drop_front(skipped);
    to_skip_ -= skipped;
    parse_whole_lines(rows);
    return true;
  }

 private:
  void drop_front(std::size_t count) {
    std::memmove(buffer_.data(), buffer_.data() + count, filled_ - count);
    filled_ -= count;
    searched_ = 0;
  }

  /// Trailing zeros after a power failure can be of any length: keeps one of them.
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

  void parse_whole_lines(CsvRows& rows) {
    const std::string_view fresh(buffer_.data() + searched_, filled_ - searched_);
    const auto last = fresh.rfind(layout_.line_end);
    if (last == std::string_view::npos) {
      searched_ = filled_;
      return;
    }
    const std::size_t end = searched_ + last + 1;
    rows.parse(buffer_.data(), buffer_.data() + end);
    drop_front(end);
    searched_ = filled_;
  }

  PeekSource& source_;
  const CsvLayout& layout_;
  std::size_t to_skip_;
  bool at_end_ = false;
  std::vector<char> buffer_ = std::vector<char>(std::size_t{256} << 10);
  std::size_t filled_ = 0;
  std::size_t searched_ = 0;  ///< bytes known to contain no line end
};

/// The first text column with more than one word, else the first; `has_figures` gives for each
/// column of the file whether it has numbers.
std::optional<std::size_t> label_column(const CsvColumns& columns,
                                        const CsvRows& rows,
                                        const std::vector<bool>& has_figures) {
  std::optional<std::size_t> constant;
  for (const auto& [column, words] : rows.words()) {
    const bool is_kept = columns.uses[column] == ColumnUse::keep && !has_figures[column];
    if (words.runs() == 0 || !(is_kept || columns.uses[column] == ColumnUse::words)) continue;
    if (words.changes(rows.rows())) return column;
    if (!constant) constant = column;
  }
  return constant;
}

class CsvReader final : public RecordingReader {
 public:
  CsvReader(std::unique_ptr<PeekSource> source,
            CsvLayout layout,
            CsvHeader header,
            CsvColumns columns,
            Progress progress)
      : source_(std::move(source)),
        layout_(std::move(layout)),
        header_(std::move(header)),
        columns_(std::move(columns)),
        has_figures_(columns_.uses.size(), false),
        feed_(*source_, layout_),
        progress_(std::move(progress)) {
    head_.recording.format = "CSV";
    head_.rate_hz = header_.rate_hz;
    if (source_->size() && layout_.bytes_per_row > 0.0)
      head_.rows =
          static_cast<std::uint64_t>(static_cast<double>(*source_->size()) / layout_.bytes_per_row);
    for (std::size_t c = 0; c < columns_.uses.size(); ++c)
      if (columns_.uses[c] == ColumnUse::keep)
        head_.recording.channels.push_back({header_.labels[c].name, header_.labels[c].unit, {}});
    if (columns_.stamps) begin_stamps();
  }

  [[nodiscard]] const RawHead& head() const override { return head_; }
  [[nodiscard]] double fraction_read() const override { return source_->fraction_read(); }

  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    if (!rows_) begin_rows(most);
    const std::size_t before = rows_->rows();
    while (rows_->rows() - before < most) {
      const auto more = feed_.step(*rows_);
      if (!more) return more.error();
      for (const auto& lines = rows_->wordy_lines(); seen_wordy_ < lines.size(); ++seen_wordy_)
        if (const auto why = contradiction(header_, layout_, lines[seen_wordy_]))
          return Error{Errc::corrupt, *why};
      if (!*more) break;
      if (progress_) progress_("reading", source_->fraction_read());
    }
    rows_->flush();
    take(rows);
    return Done{};
  }

  void finish(Recording& recording) override {
    if (!rows_->faults().out_of_step) recording.first_line = layout_.first_line;
    if (const auto labels = label_column(columns_, *rows_, has_figures_))
      take_labels(*labels, recording);
    note_layout(layout_, header_, columns_, recording.notes);
    note_faults(rows_->faults(), header_, columns_, layout_.point, recording.notes);
    std::ranges::move(source_->notes(), std::back_inserter(recording.notes));
    if (rows_->stamps() && rows_->stamps()->zone_missing())
      recording.notes.push_back({Severity::info, header_.labels[*columns_.stamps].name +
                                                     ": no time zone is given: taken as UTC"});
  }

 private:
  void begin_stamps() {
    const ColumnLabel& label = header_.labels[*columns_.stamps];
    head_.stamps = StampColumn{label.name, label.unit, {}, {}, header_.found};
    const bool counts_seconds = header_.zero_ns && label.unit.quantity == Quantity::unknown;
    if (columns_.spelling != StampSpelling::figures || counts_seconds)
      head_.stamps->unit = *parse_unit("s");
  }

  void begin_rows(std::size_t most) {
    std::optional<StampReader> stamps;
    if (columns_.stamps) stamps.emplace(columns_.spelling, layout_.point);
    rows_.emplace(layout_, columns_.uses, stamps, columns_.date,
                  std::min(expected_rows(*source_, layout_), most));
  }

  void take(RawRows& rows) {
    rows.channels.resize(head_.recording.channels.size());
    std::size_t channel = 0;
    for (std::size_t c = 0; c < columns_.uses.size(); ++c) {
      if (columns_.uses[c] != ColumnUse::keep) continue;
      rows.channels[channel] = rows_->take(c);
      const auto is_figure = [](double x) { return !std::isnan(x); };
      has_figures_[c] = has_figures_[c] || std::ranges::any_of(rows.channels[channel], is_figure);
      ++channel;
    }
    if (!columns_.stamps) return;
    rows.stamps = rows_->take(*columns_.stamps);
    head_.stamps->origin = rows_->stamps()->origin().value_or(StampOrigin{});
    // Loggers that can also write seconds since 1970 state the start in either case.
    constexpr double latest_since_start_s = 1e8;
    if (header_.zero_ns && head_.stamps->unit.to_si == 1.0 &&
        head_.stamps->origin.value() < latest_since_start_s)
      head_.stamps->origin = moved(head_.stamps->origin, *header_.zero_ns);
    if (columns_.spelling != StampSpelling::figures)
      head_.stamps->clock = rows_->stamps()->zone_missing() ? StampClock::wall : StampClock::zoned;
  }

  /// Makes a text column the recording's labels; it is then not a channel.
  void take_labels(std::size_t column, Recording& recording) {
    recording.labels = rows_->words().at(column).labels();
    recording.label_channel = header_.labels[column].name;
    columns_.labels = column;
    std::erase_if(recording.channels,
                  [&](const Channel& channel) { return channel.name == recording.label_channel; });
  }

  std::unique_ptr<PeekSource> source_;
  CsvLayout layout_;
  CsvHeader header_;
  CsvColumns columns_;
  std::vector<bool> has_figures_;  ///< for each column of the file, so far
  LineFeed feed_;
  std::optional<CsvRows> rows_;
  RawHead head_;
  Progress progress_;
  std::size_t seen_wordy_ = 0;  ///< number of CsvRows::wordy_lines()
};

}  // namespace

Result<std::unique_ptr<RecordingReader>> csv_reader(std::unique_ptr<PeekSource> source,
                                                    const ReadOptions& options) {
  const auto head = peek_head(*source);
  if (!head) return head.error();
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::size_t mark = head->starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  auto layout = infer_layout(head->substr(mark), head->size() < (std::size_t{64} << 10));
  if (!layout) return layout.error();
  CsvLayout table = std::move(layout).value();
  table.data_offset += mark;
  CsvHeader header = read_header(table);
  auto columns = choose_columns(table, header, options);
  if (!columns) return columns.error();
  if (std::ranges::count(columns->uses, ColumnUse::keep) == 0)
    return Error{Errc::too_few_samples, "has no column of numbers beside the time"};
  return std::unique_ptr<RecordingReader>(
      std::make_unique<CsvReader>(std::move(source), std::move(table), std::move(header),
                                  std::move(columns).value(), options.progress));
}

namespace {

/// The rows in the first 64 KiB, without consuming them; none if they cannot be read.
RawRows first_rows_of(PeekSource& source, const ReadOptions& options) {
  RawRows rows;
  const auto head = source.peek(std::size_t{64} << 10);
  if (!head) return rows;
  const std::string text(*head);
  ReadOptions silent = options;
  silent.progress = {};
  auto reader =
      csv_reader(std::make_unique<PeekSource>(open_memory(std::as_bytes(std::span(text)))), silent);
  if (reader && !(*reader)->next(std::numeric_limits<std::size_t>::max(), rows)) rows = {};
  return rows;
}

}  // namespace

Result<std::unique_ptr<TableFile>> open_csv(std::unique_ptr<PeekSource> source,
                                            const ReadOptions& options) {
  const RawRows first = first_rows_of(*source, options);
  auto reader = csv_reader(std::move(source), options);
  if (!reader) return reader.error();
  return only_table(rows_of_one_sensor(std::move(reader).value(), first, options));
}

}  // namespace proofmass::io
