#include "proofmass/acquire/recorder/session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <thread>
#include <utility>

#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/number_words.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::chrono::milliseconds arrival_patience{50};

bool has_same_channels(const SourceHead& a, const SourceHead& b) {
  return std::ranges::equal(a.recording.channels, b.recording.channels,
                            [](const Channel& left, const Channel& right) {
                              return left.name == right.name && left.unit == right.unit;
                            });
}

std::string names_of(const std::vector<Channel>& channels) {
  std::string names;
  for (const Channel& channel : channels) names += (names.empty() ? "" : ", ") + channel.name;
  return names;
}

}  // namespace

RecordSession::RecordSession(const OpenSource& open,
                             const RecordOptions& options,
                             const RecordWatch& watch,
                             const MakeAnalysis& make_analysis,
                             CreatePartFile create)
    : open_(open),
      options_(options),
      watch_(watch),
      make_analysis_(make_analysis),
      create_(std::move(create)),
      queue_(options.queue_bytes / 2),
      disk_(options.queue_bytes / 2, options.sync_s) {}

Result<RecordSummary> RecordSession::run() {
  if (const Status begun = begin(); !begun) return begun.error();
  loop();
  reader_->stop();
  close();
  return std::move(tally_.summary);
}

Status RecordSession::begin() {
  auto source = open_();
  while (!source && may_try_again(source.error())) source = open_();
  if (!source) return source.error();
  std::unique_ptr<Source> opened = std::move(source).value();
  if (const Status used = use(opened->head()); !used) return used;
  const bool is_numbered = options_.rotate_s || options_.rotate_bytes;
  if (const Status created = new_file(is_numbered); !created) return created;
  const HostTimes now = host_times_now();
  realtime_ahead_ns_ = now.realtime_ns - now.steady_ns;
  if (watch_.opened) watch_.opened(head_);
  reader_ = std::make_unique<SourceReader>(std::move(opened), open_, options_, queue_);
  return Done{};
}

/// Waits before retrying a source that is unavailable, or was lost while being opened, as for one
/// lost later.
bool RecordSession::may_try_again(const Error& error) {
  constexpr std::chrono::milliseconds slice{50}, between{500};
  const auto is_stopped = [&] { return watch_.stopped && watch_.stopped(); };
  if (!options_.reconnect || error.code != Errc::device) return false;
  const std::int64_t now_ns = host_now_ns();
  if (!waiting_since_ns_) {
    waiting_since_ns_ = now_ns;
    const RecordEvent event{EventKind::disconnected,
                            Severity::warning,
                            0.0,
                            0.0,
                            0,
                            "the source cannot be opened yet, or went while it was; what it sent "
                            "until now is not recorded: " +
                                error.message};
    (void)tally_.add(event);
    if (watch_.event) watch_.event(event);
  }
  if (static_cast<double>(now_ns - *waiting_since_ns_) * 1e-9 > options_.reconnect_for_s)
    return false;
  for (auto waited = slice; waited < between && !is_stopped(); waited += slice)
    std::this_thread::sleep_for(slice);
  return !is_stopped();
}

/// Setup that depends on the source's channels.
Status RecordSession::use(const SourceHead& head) {
  head_ = head;
  const std::size_t channels = head_.recording.channels.size();
  if (channels == 0) return invalid(head_.recording.source + ": has no channel to record");
  if (options_.trigger) {
    const Channel* found = head_.recording.find(options_.trigger->channel);
    if (found == nullptr)
      return invalid(fmt::format("the trigger is on {}, and {} has {}", options_.trigger->channel,
                                 head_.recording.source, names_of(head_.recording.channels)));
    trigger_channel_ = static_cast<std::size_t>(found - head_.recording.channels.data());
  }
  if (make_analysis_) {
    auto made = make_analysis_(head_);
    if (!made) return made.error();
    begin_analysis(std::move(made).value());
  }
  begin_watching();
  if (line_)
    line_->reopen(head_);
  else
    line_.emplace(head_);
  if (options_.trigger)
    gate_.emplace(*options_.trigger, trigger_channel_, channels, columns_.size(),
                  options_.queue_bytes);
  return Done{};
}

/// Starts monitoring silence and rate of an opened source.
void RecordSession::begin_watching() {
  const double rate_hz = head_.recording.time.rate_hz;
  hold_.emplace(head_.has_device_clock, head_.is_paced, rate_hz, options_.stall_s);
  rate_watch_ = RateWatch(rate_hz);
}

void RecordSession::loop() {
  QueueItem item;
  while (!end_) {
    ask_stopped();
    if (disk_.failure()) end(RecordEnd::disk_failed);
    if (end_) break;
    const bool came = queue_.take(item, arrival_patience);
    if (came) hold_->put(std::move(item));
    while (!end_ && hold_->take(item, false)) work(item);
    take_estimates(std::chrono::milliseconds(0));
    look_at_clocks();
    if (file_) file_->tick(host_now_ns());
  }
  reader_->stop();
  take_what_is_left(item);
}

/// Data read before the end are kept; after a disk failure they are counted.
void RecordSession::take_what_is_left(QueueItem& item) {
  do {
    while (hold_->take(item, true)) {
      if (end_ == RecordEnd::stopped) work(item);
      if (end_ == RecordEnd::disk_failed) rows_ += item.arrival.rows();
    }
    if (!queue_.take(item, std::chrono::milliseconds(0))) return;
    hold_->put(std::move(item));
  } while (true);
}

void RecordSession::ask_stopped() {
  if (!end_ && watch_.stopped && watch_.stopped()) end(RecordEnd::stopped);
}

void RecordSession::end(RecordEnd how, std::string reason) {
  if (end_) return;
  end_ = how;
  tally_.summary.end_reason = std::move(reason);
}

/// Compares the time of day with the monotonic clock.
void RecordSession::look_at_clocks() {
  const HostTimes now = host_times_now();
  if (now.steady_ns < next_clock_ns_) return;
  constexpr std::int64_t every_ns = 1'000'000'000;
  constexpr std::int64_t step_ns = 50'000'000;
  next_clock_ns_ = now.steady_ns + every_ns;
  const std::int64_t ahead_ns = now.realtime_ns - now.steady_ns;
  const std::int64_t jump_ns = ahead_ns - std::exchange(realtime_ahead_ns_, ahead_ns);
  if (std::abs(jump_ns) > step_ns)
    report(EventKind::host_jump, Severity::warning,
           fmt::format("the host's time of day was set {} s {}; the recording's time continues",
                       fixed(std::abs(static_cast<double>(jump_ns)) * 1e-9, 3),
                       jump_ns > 0 ? "on" : "back"));
}

void RecordSession::work(QueueItem& item) {
  report_notes(item.arrival.notes);
  switch (item.kind) {
    case QueueItem::Kind::rows:
      work_on_rows(item);
      break;
    case QueueItem::Kind::notes:
      break;
    case QueueItem::Kind::stalled:
      report(EventKind::stalled, Severity::warning,
             fmt::format("nothing has come for {:.1f} s", item.silence_s));
      break;
    case QueueItem::Kind::gone:
      gone_ = item.reason;
      report(EventKind::disconnected, Severity::bad, "the source is gone: " + gone_);
      break;
    case QueueItem::Kind::reopened:
      reopened(*item.head);
      break;
    case QueueItem::Kind::gave_up:
      end(RecordEnd::source_gone, item.reason.empty() ? gone_ : item.reason);
      break;
    case QueueItem::Kind::ended:
      end(RecordEnd::source_end);
      break;
  }
}

void RecordSession::work_on_rows(QueueItem& item) {
  const bool is_first = rows_ == 0;
  events_.clear();
  line_->stamp(item, stamps_s_, events_);
  if (is_first) {
    const double ago_s = stamps_s_.back() - stamps_s_.front();
    start_ns_ = head_.recording.time.start_ns.value_or(item.arrival.host_ns + realtime_ahead_ns_ -
                                                       static_cast<std::int64_t>(ago_s * 1e9));
    tally_.summary.clock.start_realtime_ns = start_ns_;
  }
  for (const RecordEvent& event : events_) report(event);
  tally_.add_arrival(*line_, head_, item.arrival.host_ns);
  watch_rate(item.arrival.host_ns);
  std::size_t rows = item.arrival.rows();
  if (options_.duration_s && stamps_s_.back() >= *options_.duration_s) {
    const auto over = std::ranges::lower_bound(stamps_s_, *options_.duration_s);
    rows = static_cast<std::size_t>(over - stamps_s_.begin());
    end(RecordEnd::duration);
  }
  if (rows == 0) return;
  Block block{static_cast<std::size_t>(rows_), {}, View<double>(stamps_s_).first(rows)};
  for (const std::vector<double>& channel : item.arrival.channels)
    block.channels.push_back(View<double>(channel).first(rows));
  rows_ += rows;
  tally_.summary.duration_s = stamps_s_[rows - 1];
  keep(block, item.arrival.host_ns);
  pair_clocks(item.arrival.host_ns);
}

void RecordSession::watch_rate(std::int64_t host_ns) {
  if (!head_.is_paced) return;
  const auto other = rate_watch_.add(line_->rows(), line_->host_s(host_ns));
  if (!other) return;
  report(EventKind::note, Severity::warning,
         fmt::format("rows have come at {:.4g} Hz for {:.0f} s, not at the granted {:.4g} Hz{}",
                     other->rate_hz, other->for_s, head_.recording.time.rate_hz,
                     head_.has_device_clock ? "" : ", by which their times are counted"));
}

/// Once a second, the time of day at the arrival of the last row.
void RecordSession::pair_clocks(std::int64_t host_ns) {
  if (host_ns < next_pair_ns_ || !file_ || !file_->has_begun()) return;
  constexpr std::int64_t every_ns = 1'000'000'000;
  next_pair_ns_ = host_ns + every_ns;
  file_->add_clock(line_->last_s(), {host_ns, host_ns + realtime_ahead_ns_});
}

void RecordSession::reopened(const SourceHead& head) {
  const bool is_same = has_same_channels(head, head_);
  if (is_same) {
    head_ = head;
    line_->reopen(head_);
    begin_watching();
    report(EventKind::reconnected, Severity::info, "the source is there again");
    return;
  }
  report(EventKind::reconnected, Severity::warning,
         "the source is there again with other channels: a new file begins");
  finish_analysis();
  if (const Status used = use(head); !used) {
    end(RecordEnd::source_gone, used.error().message);
    return;
  }
  rotate();
  if (watch_.opened) watch_.opened(head_);
}

}  // namespace proofmass::acquire
