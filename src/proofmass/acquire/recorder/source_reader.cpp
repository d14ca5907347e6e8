#include "proofmass/acquire/recorder/source_reader.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <utility>

#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/core/contract.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::chrono::milliseconds patience{50};

}  // namespace

SourceReader::SourceReader(std::unique_ptr<Source> source,
                           const OpenSource& open,
                           const RecordOptions& options,
                           ArrivalQueue& queue)
    : source_(std::move(source)), open_(open), options_(options), queue_(queue) {
  thread_ = std::thread([this] { run(); });
}

void SourceReader::stop() {
  stops_ = true;
  if (thread_.joinable()) thread_.join();
}

void SourceReader::run() {
  while (!stops_) {
    if (read_to_the_end()) return;
    source_.reset();
    if (options_.reconnect && reopen()) continue;
    hand_on(QueueItem::Kind::gave_up, end_);
    return;
  }
}

/// False if the source was lost.
bool SourceReader::read_to_the_end() {
  rows_ns_ = host_now_ns();
  is_stalled_ = false;
  end_.clear();
  const std::size_t channels = source_->head().recording.channels.size();
  while (!stops_) {
    const auto arrived = source_->read(item_.arrival, patience);
    if (!arrived) {
      hand_on(QueueItem::Kind::gone, arrived.error().message);
      return false;
    }
    if (*arrived == Arrived::rows) hand_on_rows(channels);
    if (*arrived != Arrived::rows && !item_.arrival.notes.empty()) hand_on(QueueItem::Kind::notes);
    if (*arrived == Arrived::ended) {
      hand_on(QueueItem::Kind::ended);
      return true;
    }
    if (*arrived == Arrived::nothing) watch_silence();
    if (end_.empty()) continue;
    hand_on(QueueItem::Kind::gone, end_);
    return false;
  }
  return true;
}

void SourceReader::hand_on_rows(std::size_t channels) {
  Arrival& arrival = item_.arrival;
  PM_EXPECTS(arrival.channels.size() == channels && arrival.rows() > 0);
  rows_ns_ = host_now_ns();
  is_stalled_ = false;
  count_on(arrival);
  const std::uint64_t rows = arrival.rows();
  const std::uint64_t lost = arrival.lost_before;
  item_.kind = QueueItem::Kind::rows;
  item_.overrun = dropped_;
  const bool is_paced = source_->head().is_paced;
  while (!queue_.put(item_, is_paced ? std::chrono::milliseconds(0) : patience)) {
    if (stops_) return;
    if (!is_paced) continue;
    dropped_ += rows + lost;
    keep_notes();
    return;
  }
  dropped_ = 0;
  if (dropped_notes_.empty()) return;
  item_.arrival.clear(channels);
  item_.arrival.notes = std::exchange(dropped_notes_, {});
  hand_on(QueueItem::Kind::notes);
}

/// A reopened source does not know its previous count.
void SourceReader::count_on(Arrival& arrival) {
  item_.is_counted = false;
  if (std::exchange(is_reopened_, false) && last_count_ && arrival.first_count) {
    RowCounter counter(0, false);
    static_cast<void>(counter.add(*last_count_));
    const CounterStep step = counter.add(*arrival.first_count);
    item_.is_counted = !step.restarted;
    if (item_.is_counted) arrival.lost_before = step.lost;
  }
  last_count_ = arrival.last_count;
}

void SourceReader::hand_on(QueueItem::Kind kind, std::string reason) {
  item_.kind = kind;
  item_.reason = std::move(reason);
  if (item_.arrival.host_ns == 0) item_.arrival.host_ns = host_now_ns();
  if (source_) item_.head = std::make_shared<const SourceHead>(source_->head());
  if (!queue_.put(item_, std::chrono::milliseconds(0))) keep_notes();
}

/// Keeps the notes that found no room for later.
void SourceReader::keep_notes() {
  constexpr std::size_t most_notes = 100;
  for (Note& note : item_.arrival.notes)
    if (dropped_notes_.size() < most_notes) dropped_notes_.push_back(std::move(note));
}

/// A source slower than the allowed silence would be reported repeatedly.
double SourceReader::stall_s() const {
  const double rate_hz = source_->head().recording.time.rate_hz;
  constexpr double rows_missing = 4.0;
  return rate_hz > 0.0 ? std::max(options_.stall_s, rows_missing / rate_hz) : options_.stall_s;
}

void SourceReader::watch_silence() {
  const double silent_s = static_cast<double>(host_now_ns() - rows_ns_) * 1e-9;
  if (!is_stalled_ && silent_s > stall_s()) {
    is_stalled_ = true;
    item_.silence_s = silent_s;
    hand_on(QueueItem::Kind::stalled);
  }
  if (silent_s > std::max(options_.stall_end_s, stall_s()))
    end_ = fmt::format("nothing came for {:.1f} s", silent_s);
}

/// Retries after a delay that increases.
bool SourceReader::reopen() {
  constexpr double first_wait_s = 0.2;
  constexpr double longest_wait_s = 5.0;
  const std::int64_t since_ns = host_now_ns();
  for (double wait_s = first_wait_s; !stops_; wait_s = std::min(2.0 * wait_s, longest_wait_s)) {
    pause(wait_s);
    if (stops_) return false;
    auto opened = open_();
    if (opened) {
      source_ = std::move(opened).value();
      item_ = QueueItem{};
      is_reopened_ = true;
      hand_on(QueueItem::Kind::reopened);
      return true;
    }
    const double tried_s = static_cast<double>(host_now_ns() - since_ns) * 1e-9;
    if (tried_s < options_.reconnect_for_s) continue;
    end_ = opened.error().message;
    return false;
  }
  return false;
}

void SourceReader::pause(double seconds) const {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!stops_ && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

}  // namespace proofmass::acquire
