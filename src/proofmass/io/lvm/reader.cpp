#include "proofmass/io/lvm/reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <utility>

#include "proofmass/io/lvm/rows.hpp"
#include "proofmass/io/lvm/segments.hpp"
#include "proofmass/io/lvm/time.hpp"
#include "proofmass/io/table_reader.hpp"
#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::lvm {
namespace {

/// State shared by all tables of a file.
struct OpenLvm {
  std::unique_ptr<RandomBytes> bytes;
  Contents contents;
};

constexpr std::int64_t second_ns = 1'000'000'000;
/// From the beginning of LabVIEW's calendar, 1904, to 1970.
constexpr std::int64_t seconds_1904_to_1970 = 2'082'844'800;

class Reader final : public TableReader {
 public:
  Reader(std::shared_ptr<const OpenLvm> file, const Table& table)
      : file_(std::move(file)),
        table_(table),
        timing_(timing_of(table)),
        rows_(*file_->bytes, file_->contents.file, table),
        figures_(table.channels.size()) {}

  /// Inspects the first rows. Errors: corrupt, unreadable.
  Status open() {
    if (const Status looked = look(); !looked) return looked;
    head_.format = "LVM";
    head_.rows = table_.rows();
    head_.notes = file_->contents.notes;
    std::ranges::copy(table_.notes, std::back_inserter(head_.notes));
    std::ranges::copy(timing_.notes, std::back_inserter(head_.notes));
    place_time();
    for (const Channel& channel : table_.channels) head_.headings.push_back(channel.heading);
    head_.columns = head_.headings.size();
    report();
    rewind();
    return Done{};
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }

  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    std::size_t done = 0;
    while (done < into[0].size() && segment_ < table_.segments.size()) {
      if (row_ == table_.segments[segment_].count) {
        ++segment_;
        begin_segment();
        continue;
      }
      double x = 0.0;
      const auto there = rows_.row(figures_, x);
      if (!there) return there.error();
      if (!*there) return Error{Errc::unreadable, "changes while it is read"};
      std::size_t column = 0;
      if (has_x_column_) into[column++][done] = time_of(x);
      for (const double figure : figures_) into[column++][done] = figure;
      ++row_;
      ++done;
    }
    return done;
  }

  [[nodiscard]] std::vector<Note> notes() const override;

  [[nodiscard]] double fraction_read() const override {
    return static_cast<double>(rows_.offset()) /
           static_cast<double>(std::max<std::uint64_t>(file_->bytes->size(), 1));
  }

 private:
  /// Finds the first row with an X value, to which the others are relative, or the first row at
  /// all.
  Status look() {
    constexpr std::size_t most = 1000;
    rows_.begin(table_.segments.front());
    for (std::size_t k = 0; k < std::min(most, table_.segments.front().count); ++k) {
      double x = 0.0;
      const auto there = rows_.row(figures_, x);
      if (!there) return there.error();
      if (!*there || !table_.x_column || rows_.first_x()) break;
    }
    return Done{};
  }

  void rewind() {
    rows_.forget();
    segment_ = 0;
    begin_segment();
  }

  void begin_segment() {
    row_ = 0;
    if (segment_ < table_.segments.size()) rows_.begin(table_.segments[segment_]);
  }

  [[nodiscard]] double time_of(double x) const {
    if (table_.x_column) return timing_.starts_s[segment_] + x;
    return timing_.starts_s[segment_] - timing_.starts_s[0] +
           static_cast<double>(row_) * timing_.steps_s[segment_];
  }

  void place_time() {
    const std::int64_t start_ns = timing_.start_ns.value_or(0);
    if (table_.x_column && !table_.x_is_time) {
      has_x_column_ = true;
      timing_.starts_s.assign(table_.segments.size(), 0.0);
      head_.headings.push_back(table_.x_heading);
      return;
    }
    if (table_.x_column) {
      place_x_values(start_ns);
      return;
    }
    const auto offset_ns = static_cast<std::int64_t>(std::llround(timing_.starts_s[0] * 1e9));
    const bool is_stamped = !timing_.rate_hz && timing_.steps_s[0] > 0.0 && table_.x_is_time;
    if (is_stamped) {
      declare_time(offset_ns, start_ns);
      return;
    }
    if (table_.x_is_time)
      head_.rate_hz = timing_.rate_hz;
    else
      head_.notes.push_back({Severity::warning, "X is not a time: " + table_.x_heading});
    std::int64_t at_ns = 0;
    if (timing_.start_ns && !__builtin_add_overflow(start_ns, offset_ns, &at_ns))
      head_.start_ns = at_ns;
  }

  /// X values are seconds since the start, or since the beginning of LabVIEW's calendar.
  void place_x_values(std::int64_t start_ns) {
    const std::int64_t first_ns = rows_.first_x() ? rows_.first_x()->ns(1.0).value_or(0) : 0;
    constexpr std::int64_t surely_absolute_ns = 1'000'000'000 * second_ns;
    const bool is_absolute = file_->contents.file.is_absolute && first_ns > surely_absolute_ns;
    if (is_absolute) timing_.starts_s.assign(table_.segments.size(), 0.0);
    declare_time(first_ns, is_absolute ? -seconds_1904_to_1970 * second_ns : start_ns);
  }

  /// Column 0 is the time, in seconds from the first row's at `first_ns` + `zero_ns`.
  void declare_time(std::int64_t first_ns, std::int64_t zero_ns) {
    has_x_column_ = true;
    head_.headings.emplace_back("X_Value (s)");
    head_.stamps = DeclaredStamps{
        0, *parse_unit("s"), {static_cast<Int128>(first_ns) + static_cast<Int128>(zero_ns), -9}};
  }

  void report() {
    const int decimals = rows_.decimals();
    if (decimals > 0)
      head_.notes.push_back(
          {Severity::info, fmt::format("values are written with {} decimals: what is finer than {} "
                                       "is not in the file",
                                       decimals, in_words(std::pow(10.0, -decimals)))});
    if (timing_.start_ns)
      head_.notes.push_back({Severity::info, "Date and Time of the file are taken as UTC"});
    double apart_s = 0.0;
    const Channel& first = table_.channels.front();
    for (const Channel& channel : table_.channels)
      if (channel.start_ns && first.start_ns)
        apart_s = std::max(
            apart_s, std::abs(static_cast<double>(*channel.start_ns - *first.start_ns) * 1e-9));
    if (apart_s > 0.0)
      head_.notes.push_back({Severity::info, fmt::format("the channels were started up to {} s "
                                                         "apart: the first one's time is taken",
                                                         in_words(apart_s))});
  }

  std::shared_ptr<const OpenLvm> file_;
  const Table& table_;
  Timing timing_;
  RowParser rows_;
  std::vector<double> figures_;
  TableHead head_;
  bool has_x_column_ = false;
  std::size_t segment_ = 0;
  std::size_t row_ = 0;
};

std::vector<Note> Reader::notes() const {
  std::vector<Note> notes = file_->bytes->notes();
  const Faults& faults = rows_.faults();
  if (faults.comments > 0)
    notes.push_back(
        {Severity::info, fmt::format("comments beside the rows: {}, the first on line {}: \"{}\"",
                                     faults.comments, faults.comment_line, faults.comment)});
  if (faults.words > 0)
    notes.push_back(
        {Severity::warning,
         fmt::format("words where figures belong: {}, the first on line {}: \"{}\": NaN",
                     faults.words, faults.word_line, faults.word)});
  if (faults.other_x > 0)
    notes.push_back(
        {Severity::warning,
         fmt::format("channels have X values of their own in {} rows, the first line "
                     "{}: those of {} are taken as all",
                     faults.other_x, faults.other_x_line, table_.channels.front().heading)});
  if (faults.cut_line)
    notes.push_back({Severity::bad, fmt::format("line {}: breaks off within the row: its last "
                                                "figure is NaN",
                                                *faults.cut_line)});
  std::size_t few = 0;
  const Rows* first = nullptr;
  for (const Rows& segment : table_.segments)
    if (segment.count < segment.claimed && few++ == 0) first = &segment;
  if (first != nullptr)
    notes.push_back(
        {Severity::bad,
         fmt::format("line {}: the segment has {} rows of the {} that its header says{}",
                     first->line, first->count, first->claimed,
                     few > 1 ? fmt::format("; so have {} more", few - 1) : "")});
  return notes;
}

class Tables final : public TableFile {
 public:
  explicit Tables(std::shared_ptr<const OpenLvm> file) : file_(std::move(file)) {
    for (const Table& table : file_->contents.tables) {
      TableSummary summary{table.name, {}, table.rows(), timing_of(table).rate_hz};
      for (const Channel& channel : table.channels) summary.headings.push_back(channel.heading);
      summaries_.push_back(std::move(summary));
    }
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return summaries_; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t table,
                                                              const ReadOptions& options) override {
    auto reader = std::make_unique<Reader>(file_, file_->contents.tables[table]);
    if (const Status opened = reader->open(); !opened) return opened.error();
    return recording_reader_of(std::move(reader), options);
  }

 private:
  std::shared_ptr<const OpenLvm> file_;
  std::vector<TableSummary> summaries_;
};

}  // namespace

bool claims(std::string_view head, std::string_view) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (head.starts_with(byte_order_mark)) head.remove_prefix(byte_order_mark.size());
  return head.starts_with("LabVIEW Measurement");
}

Result<std::unique_ptr<TableFile>> open(std::unique_ptr<PeekSource> source,
                                        const ReadOptions& options) {
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  auto file = std::make_shared<OpenLvm>();
  file->bytes = std::move(bytes).value();
  auto contents = list_segments(*file->bytes, options.progress);
  if (!contents) return contents.error();
  file->contents = std::move(contents).value();
  return std::unique_ptr<TableFile>(std::make_unique<Tables>(std::move(file)));
}

}  // namespace proofmass::io::lvm
