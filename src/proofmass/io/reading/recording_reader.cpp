#include "proofmass/io/reading/recording_reader.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "proofmass/io/column_names.hpp"
#include "proofmass/io/reading/columns.hpp"

namespace proofmass::io {
namespace {

/// Few enough values to stay in the processor's cache.
std::size_t rows_a_piece(std::size_t columns) {
  return std::clamp<std::size_t>((std::size_t{1} << 16) / columns, 16, 4096);
}

/// A table's rows with look-ahead to the first ones.
class PeekTable {
 public:
  explicit PeekTable(std::unique_ptr<TableReader> table)
      : table_(std::move(table)),
        piece_(table_->head().columns, std::vector<double>(rows_a_piece(table_->head().columns))),
        into_(piece_.begin(), piece_.end()) {}

  [[nodiscard]] const TableReader& table() const { return *table_; }
  Status peek() {
    const auto count = table_->read(into_);
    if (!count) return count.error();
    ahead_ = *count;
    return Done{};
  }
  [[nodiscard]] View<double> ahead(std::size_t column) const {
    return View<double>(piece_[column]).first(ahead_);
  }
  /// Reads the next rows into the piece.
  Result<std::size_t> next() {
    if (ahead_ > 0) return std::exchange(ahead_, 0);
    return table_->read(into_);
  }
  [[nodiscard]] std::span<double> column(std::size_t c, std::size_t count) {
    return std::span(piece_[c]).first(count);
  }
  /// Reads the next rows directly into `into`, once the look-ahead is consumed.
  Result<std::size_t> read(std::span<const std::span<double>> into) { return table_->read(into); }
  [[nodiscard]] bool has_ahead() const { return ahead_ > 0; }

 private:
  std::unique_ptr<TableReader> table_;
  std::vector<std::vector<double>> piece_;
  std::vector<std::span<double>> into_;
  std::size_t ahead_ = 0;
};

/// A table whose columns are channels and stamps.
class TableRecordingReader final : public RecordingReader {
 public:
  /// `shifts` are added to the columns.
  TableRecordingReader(PeekTable table,
                       RawHead head,
                       std::optional<std::size_t> time,
                       std::vector<double> shifts,
                       Progress progress)
      : table_(std::move(table)),
        head_(std::move(head)),
        time_(time),
        shifts_(std::move(shifts)),
        progress_(std::move(progress)) {}

  [[nodiscard]] const RawHead& head() const override { return head_; }
  [[nodiscard]] Status next(std::size_t most, RawRows& rows) override {
    rows.channels.resize(head_.recording.channels.size());
    // More rows than are ever streamed: all are requested, their number is unknown.
    constexpr std::size_t most_streamed = std::size_t{1} << 28;
    return most > most_streamed ? read_all(rows) : read_some(most, rows);
  }
  void finish(Recording& recording) override {
    std::ranges::move(table_.table().notes(), std::back_inserter(recording.notes));
  }
  [[nodiscard]] double fraction_read() const override { return table_.table().fraction_read(); }

 private:
  [[nodiscard]] std::vector<double>& place_of(std::size_t column, RawRows& rows) const {
    if (time_ == column) return rows.stamps;
    const bool is_behind_time = time_ && *time_ < column;
    return rows.channels[column - (is_behind_time ? 1 : 0)];
  }

  void shift(std::size_t column, std::span<double> values) const {
    if (shifts_[column] == 0.0) return;
    for (double& value : values) value += shifts_[column];
  }

  Status read_some(std::size_t most, RawRows& rows) {
    const std::size_t columns = shifts_.size();
    if (table_.has_ahead()) {
      const auto count = table_.next();
      for (std::size_t c = 0; c < columns; ++c) {
        const auto piece = table_.column(c, *count);
        place_of(c, rows).assign(piece.begin(), piece.end());
        shift(c, place_of(c, rows));
      }
      return Done{};
    }
    std::vector<std::span<double>> into;
    for (std::size_t c = 0; c < columns; ++c) {
      place_of(c, rows).resize(most);
      into.emplace_back(place_of(c, rows));
    }
    const auto count = table_.read(into);
    for (std::size_t c = 0; c < columns; ++c) {
      place_of(c, rows).resize(count ? *count : 0);
      shift(c, place_of(c, rows));
    }
    if (progress_) progress_("reading", fraction_read());
    return count ? Status(Done{}) : count.error();
  }

  Status read_all(RawRows& rows) {
    const std::size_t columns = shifts_.size();
    constexpr std::uint64_t most_values = 1 << 30;
    const std::uint64_t expected =
        std::min(head_.rows.value_or(0), most_values / std::uint64_t{columns});
    std::vector<GrowingColumn> gathered;
    for (std::size_t c = 0; c < columns; ++c)
      gathered.emplace_back(static_cast<std::size_t>(expected));
    for (;;) {
      const auto count = table_.next();
      if (!count) return count.error();
      if (*count == 0) break;
      for (std::size_t c = 0; c < columns; ++c) {
        shift(c, table_.column(c, *count));
        gathered[c].append(table_.column(c, *count));
      }
      if (progress_) progress_("reading", fraction_read());
    }
    for (std::size_t c = 0; c < columns; ++c) place_of(c, rows) = gathered[c].take();
    return Done{};
  }

  PeekTable table_;
  RawHead head_;
  std::optional<std::size_t> time_;
  std::vector<double> shifts_;
  Progress progress_;
};

/// The time declared by the format, unless the user names one.
std::optional<std::size_t> time_column(const TableHead& table,
                                       const NamedColumns& names,
                                       const ReadOptions& options) {
  if (table.stamps && options.time_channel.empty()) return table.stamps->column;
  return names.time;
}

/// The origin of the stamps, and the offset that makes it zero.
StampColumn stamp_column(const TableHead& table,
                         const NamedColumns& names,
                         std::size_t time,
                         View<double> first,
                         double& shift) {
  const ColumnLabel& label = names.labels[time];
  StampColumn stamps{label.name, label.unit, {}, {}, !names.are_made_up};
  if (table.stamps && table.stamps->column == time) {
    stamps.unit = table.stamps->unit;
    stamps.origin = table.stamps->origin;
    stamps.is_named = true;
  } else if (const auto origin = origin_of(first)) {
    stamps.origin = *origin;
    shift = -origin->value();
  }
  return stamps;
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> recording_reader_of(std::unique_ptr<TableReader> table,
                                                             const ReadOptions& options) {
  PeekTable peeked(std::move(table));
  if (const Status read = peeked.peek(); !read) return read.error();
  const TableHead& of = peeked.table().head();
  if (!peeked.has_ahead()) return Error{Errc::too_few_samples, "holds no sample"};
  auto named = name_columns(of.headings, of.columns, ascends(peeked.ahead(0)), options);
  if (!named) return named.error();
  const NamedColumns names = std::move(named).value();
  const auto time = time_column(of, names, options);
  RawHead head;
  head.recording.format = of.format;
  head.recording.notes = of.notes;
  std::ranges::copy(names.notes, std::back_inserter(head.recording.notes));
  head.rate_hz = of.rate_hz;
  head.start_ns = of.start_ns;
  head.rows = of.rows;
  std::vector<double> shifts(of.columns, 0.0);
  for (std::size_t c = 0; c < of.columns; ++c) {
    if (time == c) {
      head.stamps = stamp_column(of, names, c, peeked.ahead(c), shifts[c]);
      continue;
    }
    if (of.stamps && of.stamps->column == c) shifts[c] = of.stamps->origin.value();
    head.recording.channels.push_back({names.labels[c].name, names.labels[c].unit, {}});
  }
  return std::unique_ptr<RecordingReader>(std::make_unique<TableRecordingReader>(
      std::move(peeked), std::move(head), time, std::move(shifts), options.progress));
}

}  // namespace proofmass::io
