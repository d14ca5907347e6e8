#include "proofmass/io/recording_stream.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "proofmass/io/reading/channel_units.hpp"
#include "proofmass/io/reading/finish_recording.hpp"
#include "proofmass/io/reading/open_recording.hpp"
#include "proofmass/io/reading/raw_rows.hpp"
#include "proofmass/io/shown_text.hpp"
#include "proofmass/io/time/running_time.hpp"
#include "proofmass/signal/resample/counter.hpp"

namespace proofmass::io {
namespace {

constexpr std::uint64_t figure_bytes = sizeof(double);

std::size_t columns_of(const RawHead& head) {
  return head.recording.channels.size() + (head.stamps ? 1 : 0);
}

/// Some MiB, few enough for processing in the processor's caches.
std::size_t rows_a_block(const RawHead& head) {
  constexpr std::size_t figures = std::size_t{1} << 18;
  return std::clamp<std::size_t>(figures / std::max<std::size_t>(columns_of(head), 1), 1024,
                                 std::size_t{1} << 16);
}

}  // namespace

/// A reader in progress, with the decisions made on its first rows.
class RecordingStream::Reading {
 public:
  Reading(std::unique_ptr<TableFile> file,
          std::unique_ptr<RecordingReader> reader,
          ReadOptions options,
          std::string name)
      : file_(std::move(file)),
        reader_(std::move(reader)),
        options_(std::move(options)),
        name_(std::move(name)) {}

  [[nodiscard]] const Recording& head() const { return head_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool has_stamps() const { return time_->has_stamps(); }
  [[nodiscard]] std::optional<std::uint64_t> expected_samples() const {
    return reader_->head().rows;
  }

  /// True if the rows exceed the limit; those read so far are kept.
  Result<bool> exceeds(std::uint64_t most_bytes) {
    const std::uint64_t row_bytes = columns_of(reader_->head()) * figure_bytes;
    if (const auto rows = reader_->head().rows) return *rows > most_bytes / row_bytes;
    for (std::uint64_t gathered = 0; gathered <= most_bytes;) {
      const auto more = gather();
      if (!more) return more.error();
      if (!*more) return false;
      gathered += rows_of(ahead_.back()) * row_bytes;
    }
    return true;
  }

  Result<Recording> whole(std::vector<Note> notes) {
    RawRows rest;
    if (!at_end_) {
      if (const Status read = reader_->next(std::numeric_limits<std::size_t>::max(), rest); !read)
        return read.error();
      ahead_.push_back(std::move(rest));
    }
    if (ahead_.empty()) return Error{Errc::too_few_samples, "holds no sample"};
    RawRows all = ahead_.size() == 1 ? std::move(ahead_.front()) : joined(std::move(ahead_));
    auto finished = finish_recording(*reader_, std::move(all), options_);
    if (!finished) return finished.error();
    Recording recording = std::move(finished).value();
    recording.notes.insert(recording.notes.begin(), notes.begin(), notes.end());
    return recording;
  }

  /// Makes the decisions on the first rows.
  Status begin(std::vector<Note> notes) {
    if (const Status rate = check_rate(options_); !rate) return rate.error();
    notes_ = std::move(notes);
    if (ahead_.empty()) {
      const auto more = gather();
      if (!more) return more.error();
    }
    if (ahead_.empty()) return Error{Errc::too_few_samples, "holds no sample"};
    const RawHead& raw = reader_->head();
    Recording first = raw.recording;
    for (std::size_t c = 0; c < first.channels.size(); ++c)
      first.channels[c].values = ahead_.front().channels[c];
    counter_ = signal::find_counter(first);
    decide_on_time(raw, first);
    first.notes.clear();
    clean_texts(first);
    if (const Status settled = settle_units(first, options_); !settled) return settled.error();
    unit_notes_ = std::exchange(first.notes, {});
    const auto chosen = chosen_channels(first, options_.channels);
    if (!chosen) return chosen.error();
    chosen_ = *chosen;
    head_ = std::move(first);
    head_.source = name_;
    std::vector<Channel> kept;
    for (const std::size_t c : chosen_)
      kept.push_back({std::move(head_.channels[c].name), head_.channels[c].unit, {}});
    head_.channels = std::move(kept);
    compose_notes({});
    return Done{};
  }

  Result<Block> next() {
    Block block;
    for (;;) {
      const std::size_t had = settled_;
      RawRows rows;
      if (const Status read = take(rows); !read) return read.error();
      const bool is_end = rows_of(rows) == 0;
      put_before(current_, had, rows);
      current_ = std::move(rows);
      settle(is_end);
      if (settled_ > 0 || is_end) break;
    }
    if (settled_ == 0) return finished();
    block.first = given_;
    for (const std::size_t c : chosen_)
      block.channels.push_back(View<double>(current_.channels[c]).first(settled_));
    if (time_->has_stamps()) block.stamps_s = View<double>(current_.stamps).first(settled_);
    given_ += settled_;
    return block;
  }

 private:
  Result<bool> gather() {
    RawRows rows;
    if (const Status read = reader_->next(rows_a_block(reader_->head()), rows); !read)
      return read.error();
    at_end_ = rows_of(rows) == 0;
    if (!at_end_) ahead_.push_back(std::move(rows));
    return !at_end_;
  }

  /// The next rows as read; none at the end.
  Status take(RawRows& rows) {
    if (ahead_.empty() && !at_end_) {
      const auto more = gather();
      if (!more) return more.error();
    }
    if (ahead_.empty()) return Done{};
    rows = std::move(ahead_.front());
    ahead_.pop_front();
    if (!is_channel_) return Done{};
    for (double& value : rows.stamps) value += origin_;
    rows.channels.insert(rows.channels.begin(), std::exchange(rows.stamps, {}));
    return Done{};
  }

  void decide_on_time(const RawHead& raw, Recording& first) {
    TimeEvidence evidence;
    evidence.samples = rows_of(ahead_.front());
    evidence.stamps = raw.stamps;
    if (evidence.stamps) evidence.stamps->values = ahead_.front().stamps;
    evidence.header_rate_hz = raw.rate_hz;
    if (counter_) {
      evidence.counter_name = first.channels[*counter_].name;
      evidence.counter = first.channels[*counter_].values;
    }
    time_.emplace(evidence, options_);
    first.time = time_->base();
    const bool is_by_rate = first.time.source == TimeSource::given_rate;
    if (is_by_rate && !first.time.start_ns) first.time.start_ns = raw.start_ns;
    is_channel_ = time_->is_rejected();
    if (!is_channel_) return;
    // A rejected time column is an ordinary channel.
    first.channels.insert(first.channels.begin(),
                          {raw.stamps->name, raw.stamps->unit, std::move(evidence.stamps->values)});
    origin_ = raw.stamps->origin.value();
    for (double& value : first.channels.front().values.edit()) value += origin_;
    if (counter_) ++*counter_;
  }

  void settle(bool is_end) {
    const std::size_t rows = rows_of(current_);
    settled_ = rows;
    if (!time_->has_stamps()) return;
    current_.stamps.resize(rows);
    const auto counter = counter_ ? View<double>(current_.channels[*counter_]) : View<double>();
    settled_ = time_->mend(current_.stamps, counter, is_end);
  }

  Block finished() {
    Recording last = head_;
    last.notes.clear();
    last.channels = reader_->head().recording.channels;
    reader_->finish(last);
    head_.first_line = last.first_line;
    head_.labels = std::move(last.labels);
    head_.label_channel = std::move(last.label_channel);
    head_.time = [&] {
      TimeBase base = time_->base();
      if (!base.start_ns) base.start_ns = head_.time.start_ns;
      return base;
    }();
    compose_notes(last.notes);
    return {};
  }

  void compose_notes(const std::vector<Note>& at_end) {
    head_.notes = notes_;
    const auto add = [&](const std::vector<Note>& more) {
      head_.notes.insert(head_.notes.end(), more.begin(), more.end());
    };
    add(reader_->head().recording.notes);
    add(at_end);
    add(time_->notes(head_.first_line));
    add(unit_notes_);
    clean_texts(head_);
  }

  std::unique_ptr<TableFile> file_;
  std::unique_ptr<RecordingReader> reader_;
  ReadOptions options_;
  std::string name_;           ///< name of the file
  std::deque<RawRows> ahead_;  ///< read but not returned yet
  bool at_end_ = false;
  std::optional<RunningTimeBase> time_;
  std::optional<std::size_t> counter_;
  std::vector<std::size_t> chosen_;
  bool is_channel_ = false;  ///< the stamp column is not a time base, and is the first channel
  double origin_ = 0.0;
  RawRows current_;
  std::size_t settled_ = 0;  ///< rows of current_ that were returned
  std::size_t given_ = 0;
  Recording head_;
  std::vector<Note> notes_;
  std::vector<Note> unit_notes_;
};

RecordingStream::RecordingStream(std::unique_ptr<Reading> reading) : reading_(std::move(reading)) {}
RecordingStream::RecordingStream(RecordingStream&&) noexcept = default;
RecordingStream& RecordingStream::operator=(RecordingStream&&) noexcept = default;
RecordingStream::~RecordingStream() = default;

const Recording& RecordingStream::head() const {
  return reading_->head();
}
bool RecordingStream::has_stamps() const {
  return reading_->has_stamps();
}
std::optional<std::uint64_t> RecordingStream::expected_samples() const {
  return reading_->expected_samples();
}
Result<Block> RecordingStream::next() {
  auto block = reading_->next();
  if (!block) return block.error().at(reading_->name());
  return block;
}

namespace {

using Opened = std::variant<Recording, RecordingStream>;

Result<Opened> open_lone(std::unique_ptr<TableFile> file,
                         ChosenTables chosen,
                         const std::string& path,
                         const ReadOptions& options,
                         std::uint64_t most_bytes) {
  auto reader = file->open(chosen.tables.front(), options);
  if (!reader) return reader.error();
  auto reading = std::make_unique<RecordingStream::Reading>(
      std::move(file), std::move(reader).value(), options, path);
  const auto is_large = reading->exceeds(most_bytes);
  if (!is_large) return is_large.error();
  if (*is_large) {
    if (const Status begun = reading->begin(std::move(chosen.notes)); !begun) return begun.error();
    return Opened(RecordingStream(std::move(reading)));
  }
  auto whole = reading->whole(std::move(chosen.notes));
  if (!whole) return whole.error();
  Recording recording = std::move(whole).value();
  recording.source = path;
  return Opened(std::move(recording));
}

}  // namespace

Result<std::variant<Recording, RecordingStream>> open_recording(const std::string& path,
                                                                const ReadOptions& options,
                                                                std::uint64_t most_bytes) try {
  const std::string shown = path == "-" ? "standard input" : path;
  auto file = open_path(path, options);
  if (!file) return file.error().at(shown);
  auto chosen = chosen_tables_of(**file, options);
  if (!chosen) return chosen.error().at(shown);
  if (chosen->tables.size() > 1 || options.resample || options.skew_s != 0.0) {
    auto read = read_tables(**file, *chosen, options);
    if (!read) return read.error().at(shown);
    Recording recording = std::move(read).value();
    recording.source = path;
    return Opened(std::move(recording));
  }
  auto opened =
      open_lone(std::move(file).value(), std::move(chosen).value(), path, options, most_bytes);
  if (!opened) return opened.error().at(shown);
  return opened;
} catch (const std::bad_alloc&) {
  return Error{Errc::unreadable, "does not fit into memory: cut it, or choose channels"}.at(path);
}

}  // namespace proofmass::io
