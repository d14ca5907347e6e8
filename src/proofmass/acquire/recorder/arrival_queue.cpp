#include "proofmass/acquire/recorder/arrival_queue.hpp"

#include <utility>

namespace proofmass::acquire {
namespace {

/// Approximate size of an item; never 0.
std::size_t bytes_of(const QueueItem& item) {
  const Arrival& arrival = item.arrival;
  std::size_t bytes = sizeof(QueueItem) + 8 * arrival.rows() * arrival.channels.size() +
                      8 * arrival.device_ns.size();
  for (const Note& note : arrival.notes) bytes += sizeof(Note) + note.text.size();
  return bytes;
}

bool is_bounded(const QueueItem& item) {
  return item.kind == QueueItem::Kind::rows || item.kind == QueueItem::Kind::notes;
}

constexpr std::size_t most_spare_arrivals = 8;

}  // namespace

bool ArrivalQueue::put(QueueItem& item, std::chrono::milliseconds patience) {
  const std::size_t bytes = bytes_of(item);
  std::unique_lock lock(mutex_);
  if (is_bounded(item) && !changed_.wait_for(lock, patience, [&] { return has_room(bytes); }))
    return false;
  bytes_ += bytes;
  items_.push_back(std::move(item));
  item = QueueItem{};
  if (!spare_.empty()) {
    item.arrival = std::move(spare_.back());
    spare_.pop_back();
  }
  changed_.notify_all();
  return true;
}

bool ArrivalQueue::take(QueueItem& item, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [&] { return !items_.empty() || is_woken_; });
  is_woken_ = false;
  if (items_.empty()) return false;
  if (spare_.size() < most_spare_arrivals) spare_.push_back(std::move(item.arrival));
  item = std::move(items_.front());
  items_.pop_front();
  bytes_ -= bytes_of(item);
  changed_.notify_all();
  return true;
}

void ArrivalQueue::wake() {
  const std::scoped_lock lock(mutex_);
  is_woken_ = true;
  changed_.notify_all();
}

}  // namespace proofmass::acquire
